// Any float channels of an OpenEXR file by name; each is read straight into its own memory.
#include "io/read_exr_channels.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfThreading.h>
#include <fmt/format.h>

#include <algorithm>

#include "io/exr_checks.h"
#include "io/exr_chunks.h"
#include "io/exr_windows.h"

namespace lobelia {

namespace {

/// Returns the names of the channels to read.
Result<std::vector<std::string>> chosen(const Imf::Header& header, std::string_view name,
                                        const ReadChannelsOptions& options) {
    std::vector<std::string> names = options.wanted;
    for (const std::string& wanted : names)
        if (!header.channels().findChannel(wanted)) return Error{fmt::format("{}: no channel {}", name, wanted)};
    if (names.empty())
        for (auto c = header.channels().begin(); c != header.channels().end(); ++c) names.emplace_back(c.name());
    if (names.empty()) return Error{fmt::format("{}: no channels", name)};
    for (const std::string& channel : names)
        if (const Status status = io::check_sampling(header, channel, name, 1); !status) return status.error();
    return names;
}

/// Decodes the channels; OpenEXR reports faults of the file as exceptions.
Result<ExrPlanes> decode(io::ExrInput& in, const io::ExrHeaders& headers, std::string_view name,
                         const ReadChannelsOptions& options, const ReadOptions& limits) {
    // Choose the channels and check their size. A missing table of chunks is not reconstructed.
    Imf::MultiPartInputFile file(in, Imf::globalThreadCount(), false);
    const Imf::Header& header = file.header(0);
    if (io::is_deep(header)) return Error{fmt::format("{}: a deep OpenEXR image", name)};
    auto names = chosen(header, name, options);
    if (!names) return names.error();
    if (const Status status = io::check_part(header, name, in.size(), names->size(), limits); !status)
        return status.error();
    const io::ExrWindow data = io::data_window(header), display = io::display_window(header);
    ExrPlanes result{
        static_cast<std::size_t>(display.width()), static_cast<std::size_t>(display.height()), *std::move(names), {}};
    const std::size_t pixels = std::max(data.pixels(), display.pixels());
    if (pixels > options.most_values / result.names.size())
        return Error{fmt::format("{}: {} channels of {} x {} pixels are more than {} values", name, result.names.size(),
                                 result.width, result.height, options.most_values)};

    // Read them.
    Imf::InputPart part(file, 0);
    if (const Status status = io::check_chunks(in, headers, part, name); !status) return status.error();
    const auto& window = header.dataWindow();
    const std::size_t row = static_cast<std::size_t>(data.width()) * sizeof(float);
    Imf::FrameBuffer target;
    for (const std::string& channel : result.names) {
        float* plane = result.planes.emplace_back(data.pixels()).data();
        target.insert(channel, Imf::Slice::Make(Imf::FLOAT, plane, window, sizeof(float), row));
    }
    part.setFrameBuffer(target);
    part.readPixels(window.min.y, window.max.y);
    for (auto& plane : result.planes) plane = io::placed(std::move(plane), data, display);
    return result;
}

Result<ExrPlanes> read(io::ExrInput& in, std::string_view name, const ReadChannelsOptions& options) {
    ReadOptions limits;
    limits.most_pixels = options.most_pixels;
    const auto headers = io::check_exr_headers(in, name, limits, options.most_channels);
    if (!headers) return headers.error();
    return io::without_exceptions(in, name, [&] { return decode(in, *headers, name, options, limits); });
}

}  // namespace

Result<ExrPlanes> read_exr_channels(const std::filesystem::path& path, const ReadChannelsOptions& options) {
    auto file = InputFile::open(path);
    if (!file) return file.error();
    const std::string name = file->name();
    io::FileInput in(*std::move(file));
    return read(in, name, options);
}

Result<ExrPlanes> read_exr_channels(std::span<const std::byte> bytes, std::string_view name,
                                    const ReadChannelsOptions& options) {
    io::MemoryInput in(bytes, std::string(name));
    return read(in, name, options);
}

}  // namespace lobelia
