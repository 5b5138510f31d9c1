// OpenEXR files with named float channels, made in memory and written atomically.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfRgba.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/exr_stream.h"
#include "io/image_checks.h"
#include "io/write_file.h"
#include "io/write_image.h"

namespace lobelia {

namespace {

half saturated_half(float value) {
    if (!std::isfinite(value)) return half(value);
    return half(std::clamp(value, -65504.0f, 65504.0f));
}

Status check(std::size_t width, std::size_t height, std::span<const ExrChannel> channels) {
    constexpr std::size_t k_longest_name = 255;
    if (width == 0 || height == 0 || width > io::k_most_side || height > io::k_most_side)
        return Error{fmt::format("an OpenEXR image of {} x {} pixels cannot be written", width, height)};
    if (channels.empty()) return Error{"an OpenEXR image without channels cannot be written"};
    for (const ExrChannel& channel : channels) {
        if (channel.name.empty() || channel.name.size() > k_longest_name ||
            channel.name.find('\0') != std::string::npos)
            return Error{fmt::format("\"{}\" cannot be the name of an OpenEXR channel", channel.name)};
        if (std::count_if(channels.begin(), channels.end(), [&](const auto& c) { return c.name == channel.name; }) > 1)
            return Error{fmt::format("two OpenEXR channels have the name {}", channel.name)};
        if (channel.stride == 0 || channel.data.size() < (width * height - 1) * channel.stride + 1)
            return Error{fmt::format("the channel {} has {} floats, stride {}: too few for {} x {} pixels",
                                     channel.name, channel.data.size(), channel.stride, width, height)};
    }
    return Done{};
}

std::string encode(std::size_t width, std::size_t height, std::span<const ExrChannel> channels,
                   const ExrOptions& options) {
    const bool is_half = options.precision == ExrOptions::Precision::half;
    const Imf::PixelType type = is_half ? Imf::HALF : Imf::FLOAT;
    Imf::Header header(static_cast<int>(width), static_cast<int>(height));
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer source;
    std::vector<std::vector<half>> halves(is_half ? channels.size() : 0);

    // Point OpenEXR at the floats, or at halves made of them.
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const ExrChannel& channel = channels[c];
        header.channels().insert(channel.name, Imf::Channel(type));
        const void* data = channel.data.data();
        std::size_t stride = channel.stride * sizeof(float);
        if (is_half) {
            halves[c].resize(width * height);
            for (std::size_t i = 0; i < halves[c].size(); ++i)
                halves[c][i] = saturated_half(channel.data[i * channel.stride]);
            data = halves[c].data();
            stride = sizeof(half);
        }
        source.insert(channel.name, Imf::Slice::Make(type, data, header.dataWindow(), stride, stride * width));
    }

    // Write; the table of chunks is complete once the file object is gone.
    io::MemoryOutput out("OpenEXR image");
    {
        Imf::OutputFile file(out, header);
        file.setFrameBuffer(source);
        file.writePixels(static_cast<int>(height));
    }
    return out.take();
}

}  // namespace

Result<std::string> encode_exr(std::size_t width, std::size_t height, std::span<const ExrChannel> channels,
                               const ExrOptions& options) {
    if (const Status status = check(width, height, channels); !status) return status.error();
    try {
        return encode(width, height, channels, options);
    } catch (const std::exception& error) {
        return Error{fmt::format("the OpenEXR image cannot be encoded: {}", error.what())};
    }
}

Result<std::string> encode_exr(const Image& image, const ExrOptions& options) {
    if (image.pixels.empty()) return encode_exr(image.width, image.height, {}, options);
    // The three channels are interleaved in memory.
    const std::span<const float> floats(&image.pixels[0].r, 3 * image.pixels.size());
    static_assert(sizeof(Rgb) == 3 * sizeof(float));
    const std::vector<ExrChannel> channels{{"R", floats, 3}, {"G", floats.subspan(1), 3}, {"B", floats.subspan(2), 3}};
    return encode_exr(image.width, image.height, channels, options);
}

Status write_exr(const std::filesystem::path& path, const Image& image, const ExrOptions& options) {
    const Result<std::string> bytes = encode_exr(image, options);
    if (!bytes) return Error{fmt::format("{}: {}", path.string(), bytes.error().message)};
    return write_file_atomically(path, *bytes);
}

}  // namespace lobelia
