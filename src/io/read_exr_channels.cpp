// Any float channels of an OpenEXR file by name; planes are read in place, each into its own memory.
#include "io/read_exr_channels.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfThreading.h>
#include <fmt/format.h>

#include <cerrno>
#include <system_error>

#include "io/exr_headers.h"
#include "io/exr_parts.h"
#include "io/exr_stream.h"

namespace lobelia {

namespace {

/// The channels to read, by name.
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

/// Everything that may throw: faults of the file arrive as exceptions of OpenEXR.
Result<ExrPlanes> decode(io::ExrInput& in, std::string_view name, const ReadChannelsOptions& options,
                         const ReadOptions& limits) {
    // Choose the channels and see to their size. A missing table of chunks is not searched for.
    Imf::MultiPartInputFile file(in, Imf::globalThreadCount(), false);
    const Imf::Header& header = file.header(0);
    if (io::is_deep(header)) return Error{fmt::format("{}: a deep OpenEXR image", name)};
    auto names = chosen(header, name, options);
    if (!names) return names.error();
    if (const Status status = io::check_part(header, name, in.size(), names->size(), limits); !status)
        return status.error();
    const io::ExrSize size = io::size_of(header);
    ExrPlanes result{
        static_cast<std::size_t>(size.width), static_cast<std::size_t>(size.height), *std::move(names), {}};
    const std::size_t pixels = result.width * result.height;
    if (pixels > options.most_values / result.names.size())
        return Error{fmt::format("{}: {} channels of {} x {} pixels are more than {} values", name, result.names.size(),
                                 size.width, size.height, options.most_values)};

    // Read them.
    Imf::InputPart part(file, 0);
    const auto& window = header.dataWindow();
    Imf::FrameBuffer target;
    for (const std::string& channel : result.names) {
        float* plane = result.planes.emplace_back(pixels).data();
        target.insert(channel,
                      Imf::Slice::Make(Imf::FLOAT, plane, window, sizeof(float), result.width * sizeof(float)));
    }
    part.setFrameBuffer(target);
    part.readPixels(window.min.y, window.max.y);
    return result;
}

Result<ExrPlanes> read(io::ExrInput& in, std::string_view name, const ReadChannelsOptions& options) {
    ReadOptions limits;
    limits.most_pixels = options.most_pixels;
    if (const Status status = io::check_exr_headers(in, name, limits, options.most_channels); !status)
        return status.error();
    try {
        return decode(in, name, options, limits);
    } catch (const std::exception& error) {
        return Error{fmt::format("{}: damaged or incomplete OpenEXR: {} (near byte {} of {})", name, error.what(),
                                 in.tellg(), in.size())};
    }
}

}  // namespace

Result<ExrPlanes> read_exr_channels(const std::filesystem::path& path, const ReadChannelsOptions& options) {
    const std::string name = path.string();
    std::error_code code;
    const std::uintmax_t size =
        std::filesystem::is_regular_file(path, code) ? std::filesystem::file_size(path, code) : 0;
    if (!code && size == 0) return Error{name + ": empty, or not a regular file"};
    errno = 0;
    io::FileInput::Handle handle(code ? nullptr : std::fopen(path.c_str(), "rb"), std::fclose);
    if (!handle)
        return Error{
            fmt::format("{}: cannot be read: {}", name, std::generic_category().message(code ? code.value() : errno))};
    io::FileInput in(std::move(handle), size, name);
    return read(in, name, options);
}

Result<ExrPlanes> read_exr_channels(std::span<const std::byte> bytes, std::string_view name,
                                    const ReadChannelsOptions& options) {
    io::MemoryInput in(bytes, std::string(name));
    return read(in, name, options);
}

}  // namespace lobelia
