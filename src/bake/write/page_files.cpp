// Lightmap pages as OpenEXR files with named channels.
#include "bake/write/page_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "io/read_exr_channels.h"

namespace lobelia {
namespace {

/// Charts are stored in float32.
constexpr std::uint32_t k_most_charts = 1u << 24;

Error at(const std::filesystem::path& path, const std::string& channel, std::size_t texel, std::size_t width) {
    return Error{fmt::format("{}: channel {}, x = {}, y = {}", path.string(), channel, texel % width, texel / width)};
}

/// The first value that is not as it should be.
template <class Holds>
Status check_plane(const std::filesystem::path& path, const std::string& channel, std::span<const float> plane,
                   std::size_t width, std::string_view what, const Holds& holds) {
    const auto bad = std::find_if_not(plane.begin(), plane.end(), holds);
    if (bad == plane.end()) return Done{};
    const auto texel = static_cast<std::size_t>(bad - plane.begin());
    return Error{at(path, channel, texel, width).message + fmt::format(": {} is {}", *bad, what)};
}

Status check_values(const std::filesystem::path& path, const ExrPlanes& file, std::size_t channels) {
    for (std::size_t i = 0; i < file.names.size(); ++i) {
        const auto finite = [](float v) { return std::isfinite(v); };
        if (auto s = check_plane(path, file.names[i], file.planes[i], file.width, "not finite", finite); !s) return s;
    }
    const auto share = [](float v) { return v >= 0 && v <= 1; };
    if (auto s = check_plane(path, "validity", file.planes[channels], file.width, "not in [0, 1]", share); !s) return s;
    const auto number = [](float v) { return v >= 0 && v <= static_cast<float>(k_most_charts) && v == std::floor(v); };
    return check_plane(path, "chart", file.planes[channels + 1], file.width, "not a valid chart number", number);
}

}  // namespace

std::vector<std::string> page_channel_names(const PageChannels& channels) {
    std::vector<std::string> names = channels.names();
    for (const char* name : {"validity", "chart", "N.x", "N.y", "N.z"}) names.emplace_back(name);
    return names;
}

Status write_page(StagedFile& file, const LightmapPage& page, const PageChannels& channels,
                  std::span<const Vec3> normals, const ExrOptions& options) {
    assert(page.planes.size() == channels.count() && normals.size() == page.size());
    if (std::any_of(page.chart.begin(), page.chart.end(), [](std::uint32_t c) { return c > k_most_charts; }))
        return Error{fmt::format("more than {} charts cannot be written", k_most_charts)};
    const std::vector<float> chart(page.chart.begin(), page.chart.end());

    const auto names = page_channel_names(channels);
    std::vector<ExrChannel> planes;
    for (std::size_t i = 0; i < channels.count(); ++i) planes.push_back({names[i], page.planes[i]});
    planes.push_back({"validity", page.validity});
    planes.push_back({"chart", chart, 1, Precision::full});
    // Components are interleaved in memory.
    static_assert(sizeof(Vec3) == 3 * sizeof(float));
    const std::span<const float> floats(normals.empty() ? nullptr : &normals[0].x, 3 * normals.size());
    for (std::size_t k = 0; k < 3 && !normals.empty(); ++k)
        planes.push_back({names[channels.count() + 2 + k], floats.subspan(k), 3});
    return write_exr(file, page.width, page.height, planes, options);
}

Result<PageContent> read_page(const std::filesystem::path& path, const PageChannels& channels, std::size_t width,
                              std::size_t height) {
    // Read what should be there.
    ReadChannelsOptions options{.wanted = page_channel_names(channels), .most_pixels = width * height};
    auto file = read_exr_channels(path, options);
    if (!file) return file.error();
    if (file->width != width || file->height != height)
        return Error{fmt::format("{}: {} x {} texels, but the manifest says {} x {}", path.string(), file->width,
                                 file->height, width, height)};
    const std::size_t count = channels.count();
    if (auto status = check_values(path, *file, count); !status) return status.error();

    // Take the planes over.
    PageContent result;
    LightmapPage& page = result.page;
    page.width = width;
    page.height = height;
    page.validity = std::move(file->planes[count]);
    page.chart.assign(file->planes[count + 1].begin(), file->planes[count + 1].end());
    result.normals.resize(page.size());
    const auto* normal = &file->planes[count + 2];
    for (std::size_t i = 0; i < page.size(); ++i) {
        const Vec3 n{normal[0][i], normal[1][i], normal[2][i]};
        // Halves are off by up to 2^-12; what is of unit length but for rounding stays as it is.
        const float off = std::abs(dot(n, n) - 1);
        result.normals[i] = length(n) > 0 && off > 1e-6f ? normalize(n) : n;
    }
    file->planes.resize(count);
    page.planes = std::move(file->planes);
    return result;
}

}  // namespace lobelia
