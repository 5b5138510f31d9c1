// Plain lightmaps, and THE list of them.
#include "bake/write/lightmap_exports.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "io/texture/container.h"
#include "io/write_image.h"

namespace lobelia {
namespace {

constexpr std::array k_exports = {
    LightmapExport{"rgb", "irradiance E [W/m^2]", 1},
    LightmapExport{"rgb-over-pi", "irradiance over pi: what a white Lambertian surface reflects [W/(m^2 sr)]",
                   1 / k_pi},
};

/// Red, green and blue of irradiance times a factor, at least 0.
std::array<std::vector<float>, 3> irradiance_of(const LightmapPage& page, const PageChannels& channels, double factor) {
    std::array<std::vector<float>, 3> rgb;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto& plane = page.planes[channels.irradiance(k)];
        rgb[k].resize(page.size());
        std::transform(plane.begin(), plane.end(), rgb[k].begin(),
                       [&](float e) { return static_cast<float>(std::max(0.0, factor * static_cast<double>(e))); });
    }
    return rgb;
}

Status write_texture_of(StagedFile& file, const LightmapPage& page, const std::array<std::vector<float>, 3>& rgb,
                        float scale, std::string_view what) {
    std::array<std::vector<float>, 3> scaled = rgb;
    for (auto& plane : scaled)
        for (float& value : plane) value /= scale;
    const std::array<const float*, 3> planes = {scaled[0].data(), scaled[1].data(), scaled[2].data()};
    constexpr PixelFormat format = PixelFormat::bc6h_unsigned;
    std::vector<std::byte> data(byte_size(format, page.width, page.height));
    encode_texels(format, page.width, page.height, planes, data);
    return write_texture(*find_texture_container("ktx2").value(), file,
                         {format,
                          page.width,
                          page.height,
                          {data},
                          {{"lobelia.channels", std::string(what)}, {"lobelia.scale", fmt::format("{}", scale)}}});
}

}  // namespace

std::span<const LightmapExport> lightmap_exports() { return k_exports; }

Result<std::vector<const LightmapExport*>> find_lightmap_exports(const std::optional<std::vector<std::string>>& names) {
    std::vector<const LightmapExport*> found;
    if (!names) return found;
    for (const std::string& name : *names) {
        const auto entry =
            std::find_if(k_exports.begin(), k_exports.end(), [&](const LightmapExport& e) { return e.name == name; });
        if (entry == k_exports.end()) {
            std::string known;
            for (const LightmapExport& e : k_exports) known += (known.empty() ? "" : ", ") + std::string(e.name);
            return Error{fmt::format("unknown export \"{}\"; available: {}", name, known)};
        }
        if (std::find(found.begin(), found.end(), &*entry) == found.end()) found.push_back(&*entry);
    }
    return found;
}

Status add_exports(FilesTogether& files, const Bake& bake, const std::vector<const LightmapExport*>& exports,
                   Manifest& manifest) {
    for (const LightmapExport* entry : exports)
        for (std::size_t i = 0; i < bake.pages.size(); ++i) {
            const LightmapPage& page = bake.pages[i];
            const auto rgb = irradiance_of(page, bake.channels(), entry->factor);
            const std::string stem = fmt::format("page-{}.{}", i, entry->name);

            // Write red, green and blue, which is all that some readers accept.
            auto status = files.add(stem + ".exr", [&](StagedFile& file) {
                const std::vector<ExrChannel> channels{{"R", rgb[0]}, {"G", rgb[1]}, {"B", rgb[2]}};
                return write_exr(file, page.width, page.height, channels, {manifest.precision});
            });
            if (!status) return status;

            // Write the texture.
            float largest = 0;
            for (const auto& plane : rgb) largest = std::max(largest, largest_magnitude(plane.data(), plane.size()));
            const float scale = storing_scale(PixelFormat::bc6h_unsigned, largest);
            if (scale != 1)
                manifest.warnings.push_back(
                    fmt::format("{}.ktx2: values up to {:g} are divided by {:g}, for half floats cannot hold them",
                                stem, largest, scale));
            status = files.add(stem + ".ktx2", [&](StagedFile& file) {
                return write_texture_of(file, page, rgb, scale, entry->description);
            });
            if (!status) return status;
        }
    return Done{};
}

}  // namespace lobelia
