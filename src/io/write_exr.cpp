// OpenEXR files with named float channels, made in memory and written atomically.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfRgba.h>
#include <OpenEXR/ImfThreading.h>
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

/// Some consecutive rows of all channels as OpenEXR takes them: floats where they are, halves in a buffer.
class Band {
  public:
    Band(std::size_t width, std::span<const ExrChannel> channels, const ExrOptions& options)
        : width_(width), channels_(channels) {
        for (const ExrChannel& channel : channels) {
            const bool is_half = channel.precision.value_or(options.precision) == ExrOptions::Precision::half;
            types_.push_back(is_half ? Imf::HALF : Imf::FLOAT);
        }
    }

    [[nodiscard]] Imf::PixelType type(std::size_t channel) const { return types_[channel]; }

    /// Whole chunks of the compression: as many as fit a small buffer, but one for each thread.
    [[nodiscard]] std::size_t most_rows() const {
        constexpr std::size_t k_most_halves = std::size_t{1} << 21, k_chunk = 16;
        const auto halves = static_cast<std::size_t>(std::count(types_.begin(), types_.end(), Imf::HALF));
        const auto threads = static_cast<std::size_t>(std::max(Imf::globalThreadCount(), 1));
        return std::max(k_most_halves / std::max<std::size_t>(halves * width_, 1) / k_chunk, threads) * k_chunk;
    }

    /// Rows [first, first + rows).
    [[nodiscard]] Imf::FrameBuffer rows(std::size_t first, std::size_t rows) {
        const auto y = static_cast<int>(first);
        const Imath::Box2i window({0, y}, {static_cast<int>(width_) - 1, y + static_cast<int>(rows) - 1});
        halves_.resize(static_cast<std::size_t>(std::count(types_.begin(), types_.end(), Imf::HALF)) * width_ * rows);
        half* next = halves_.data();
        Imf::FrameBuffer source;
        for (std::size_t c = 0; c < channels_.size(); ++c) {
            const ExrChannel& channel = channels_[c];
            const float* floats = channel.data.data() + first * width_ * channel.stride;
            const void* data = floats;
            std::size_t stride = channel.stride * sizeof(float);
            if (types_[c] == Imf::HALF) {
                data = next;
                stride = sizeof(half);
                for (std::size_t i = 0; i < width_ * rows; ++i) *next++ = saturated_half(floats[i * channel.stride]);
            }
            source.insert(channel.name, Imf::Slice::Make(types_[c], data, window, stride, stride * width_));
        }
        return source;
    }

  private:
    std::size_t width_;
    std::span<const ExrChannel> channels_;
    std::vector<Imf::PixelType> types_;
    std::vector<half> halves_;
};

/// Throws what OpenEXR and the stream throw.
void encode(Imf::OStream& out, std::size_t width, std::size_t height, std::span<const ExrChannel> channels,
            const ExrOptions& options) {
    Band band(width, channels, options);
    Imf::Header header(static_cast<int>(width), static_cast<int>(height));
    header.compression() = Imf::ZIP_COMPRESSION;
    for (std::size_t c = 0; c < channels.size(); ++c)
        header.channels().insert(channels[c].name, Imf::Channel(band.type(c)));

    // The table of chunks is complete once the file object is gone.
    Imf::OutputFile file(out, header);
    for (std::size_t y = 0; y < height; y += band.most_rows()) {
        const std::size_t rows = std::min(band.most_rows(), height - y);
        file.setFrameBuffer(band.rows(y, rows));
        file.writePixels(static_cast<int>(rows));
    }
}

/// Its three channels, which are interleaved in memory; none of an empty image.
std::vector<ExrChannel> channels_of(const Image& image) {
    if (image.pixels.empty()) return {};
    const std::span<const float> floats(&image.pixels[0].r, 3 * image.pixels.size());
    static_assert(sizeof(Rgb) == 3 * sizeof(float));
    return {{"R", floats, 3}, {"G", floats.subspan(1), 3}, {"B", floats.subspan(2), 3}};
}

}  // namespace

Result<std::string> encode_exr(std::size_t width, std::size_t height, std::span<const ExrChannel> channels,
                               const ExrOptions& options) {
    if (const Status status = check(width, height, channels); !status) return status.error();
    try {
        io::MemoryOutput out("OpenEXR image");
        encode(out, width, height, channels, options);
        return out.take();
    } catch (const std::exception& error) {
        return Error{fmt::format("the OpenEXR image cannot be encoded: {}", error.what())};
    }
}

Result<std::string> encode_exr(const Image& image, const ExrOptions& options) {
    return encode_exr(image.width, image.height, channels_of(image), options);
}

Status check_finite(const Image& image) {
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const Rgb p = image.pixels[i];
        if (!std::isfinite(p.r) || !std::isfinite(p.g) || !std::isfinite(p.b))
            return Error{fmt::format("pixel x = {}, y = {} is ({:g}, {:g}, {:g}), not finite: beyond float32",
                                     i % image.width, i / image.width, p.r, p.g, p.b)};
    }
    return Done{};
}

Status write_exr(StagedFile& file, const Image& image, const ExrOptions& options) {
    if (const Status status = check_finite(image); !status) return status.error();
    return write_exr(file, image.width, image.height, channels_of(image), options);
}

Status write_exr(const std::filesystem::path& path, const Image& image, const ExrOptions& options) {
    if (const Status status = check_finite(image); !status)
        return Error{fmt::format("{}: {}", path.string(), status.error().message)};
    const Result<std::string> bytes = encode_exr(image, options);
    if (!bytes) return Error{fmt::format("{}: {}", path.string(), bytes.error().message)};
    return write_file_atomically(path, *bytes);
}

Status write_exr(StagedFile& file, std::size_t width, std::size_t height, std::span<const ExrChannel> channels,
                 const ExrOptions& options) {
    if (const Status status = check(width, height, channels); !status) return status.error();
    io::StagedOutput out(file);
    try {
        encode(out, width, height, channels, options);
    } catch (const std::exception& error) {
        if (out.status()) return Error{fmt::format("the OpenEXR image cannot be encoded: {}", error.what())};
    }
    // OpenEXR does not report failures to write the table of chunks.
    return out.status();
}

}  // namespace lobelia
