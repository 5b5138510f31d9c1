// Radiance pictures (.hdr, .pic), in every orientation and run-length scheme, RGBE and XYZE. After Ward, "Real Pixels"
// (1991).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "io/hdr_header.h"
#include "io/image_checks.h"

namespace lobelia {

namespace {

using io::HdrHeader;
using io::HdrOrientation;

/// Mantissas and the common exponent, as stored.
using StoredTexel = std::array<std::uint8_t, 4>;

/// The fault of a scanline; empty if it was decoded.
using Problem = std::optional<std::string>;

constexpr const char* k_truncated = "the file ends too early";

// Scanlines of these lengths may be compressed component by component.
constexpr std::size_t k_least_new_rle = 8, k_most_new_rle = 32767;

/// The unread bytes of the file.
class Cursor {
  public:
    Cursor(std::span<const std::byte> bytes, std::size_t offset) : bytes_(bytes), offset_(offset) {}
    [[nodiscard]] std::size_t offset() const { return offset_; }
    [[nodiscard]] std::size_t remaining() const { return bytes_.size() - offset_; }
    [[nodiscard]] std::uint8_t peek(std::size_t ahead) const {
        return std::to_integer<std::uint8_t>(bytes_[offset_ + ahead]);
    }
    [[nodiscard]] std::uint8_t take() { return std::to_integer<std::uint8_t>(bytes_[offset_++]); }
    [[nodiscard]] StoredTexel take_texel() {
        const StoredTexel texel{peek(0), peek(1), peek(2), peek(3)};
        offset_ += 4;
        return texel;
    }

  private:
    std::span<const std::byte> bytes_;
    std::size_t offset_;
};

/// Whole texels; a texel (1, 1, 1, n) repeats the one before it n times, and directly after another such, n * 256 ...
Problem decode_flat_or_old_rle(Cursor& in, std::span<StoredTexel> line) {
    unsigned shift = 0;
    for (std::size_t i = 0; i < line.size();) {
        if (in.remaining() < 4) return k_truncated;
        const StoredTexel texel = in.take_texel();
        if (texel[0] != 1 || texel[1] != 1 || texel[2] != 1) {
            line[i++] = texel;
            shift = 0;
            continue;
        }
        if (i == 0) return "a run before the first texel";
        if (shift > 24) return "a run is longer than any scanline";
        const std::size_t count = std::size_t{texel[3]} << shift;
        if (count > line.size() - i)
            return fmt::format("a run of {} texels overruns the scanline by {}", count, count - (line.size() - i));
        std::fill_n(line.begin() + static_cast<std::ptrdiff_t>(i), count, line[i - 1]);
        i += count;
        shift += 8;
    }
    return std::nullopt;
}

/// One component of a scanline: packets of a repeated byte (code above 128) or of literal bytes.
Problem decode_component(Cursor& in, std::span<StoredTexel> line, std::size_t component) {
    for (std::size_t i = 0; i < line.size();) {
        if (in.remaining() < 2) return k_truncated;
        const std::uint8_t code = in.take();
        const std::size_t count = code > 128 ? code - 128u : code;
        if (count == 0) return "a packet of length 0";
        if (count > line.size() - i)
            return fmt::format("a packet of {} bytes overruns the scanline by {}", count, count - (line.size() - i));
        if (code > 128) {
            const std::uint8_t value = in.take();
            for (std::size_t k = 0; k < count; ++k) line[i + k][component] = value;
        } else {
            if (in.remaining() < count) return k_truncated;
            for (std::size_t k = 0; k < count; ++k) line[i + k][component] = in.take();
        }
        i += count;
    }
    return std::nullopt;
}

/// Decodes a scanline in the scheme that its first bytes indicate.
Problem decode_scanline(Cursor& in, std::span<StoredTexel> line) {
    const bool may_be_new = line.size() >= k_least_new_rle && line.size() <= k_most_new_rle && in.remaining() >= 4;
    if (!may_be_new || in.peek(0) != 2 || in.peek(1) != 2 || in.peek(2) > 127) return decode_flat_or_old_rle(in, line);
    const StoredTexel head = in.take_texel();
    const std::size_t length = head[2] * 256u + head[3];
    if (length != line.size()) return fmt::format("a scanline states {} texels, not {}", length, line.size());
    for (std::size_t component = 0; component < 4; ++component)
        if (Problem problem = decode_component(in, line, component)) return problem;
    return std::nullopt;
}

/// No scanline of `length` texels takes fewer bytes than this. Old runs compress best: after one texel, runs of up to
/// 255, 255 * 256 ... texels take 4 bytes each. (New runs take 8 bytes per 127 texels: more, for every length.)
std::size_t least_scanline_bytes(std::size_t length) {
    std::size_t bytes = 4;
    std::size_t reach = 1, run = 255;
    while (reach < length) {
        bytes += 4;
        reach += run;
        run *= 256;
    }
    return bytes;
}

/// Converts stored texels to linear Rec. 709.
class TexelDecoder {
  public:
    explicit TexelDecoder(const HdrHeader& header) {
        // A component is m * 2^(E - 128) / 256, without half a step added; E = 0 is black.
        for (int e = 1; e < 256; ++e) power_[static_cast<std::size_t>(e)] = std::ldexp(1.0f, e - 136);
        // The columns of the matrix are the colours of the unit texels, as the conversion is linear.
        for (std::size_t i = 0; i < 3; ++i) {
            const std::array<double, 3> unit{i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0};
            const Rgb colour =
                header.encoding == HdrHeader::Encoding::xyze ? from_xyz(unit, header.white) : from_rgb(unit);
            columns_[i] = colour * static_cast<float>(1 / header.multiplier[i]);
        }
    }

    [[nodiscard]] Rgb operator()(const StoredTexel& t) const {
        const float scale = power_[t[3]];
        return columns_[0] * (t[0] * scale) + columns_[1] * (t[1] * scale) + columns_[2] * (t[2] * scale);
    }

  private:
    static Rgb from_rgb(const std::array<double, 3>& c) {
        return {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])};
    }
    static Rgb from_xyz(const std::array<double, 3>& c, Chromaticity white) {
        const Xyz adapted = adapt_to_d65({c[0], c[1], c[2]}, white);
        return rgb_from({adapted.x / k_white_efficacy, adapted.y / k_white_efficacy, adapted.z / k_white_efficacy});
    }

    std::array<float, 256> power_{};
    std::array<Rgb, 3> columns_{};
};

/// Index of texel `i` of scanline `line` in an image stored row by row from the top left.
std::size_t pixel_index(const Image& image, const HdrOrientation& orientation, std::size_t line, std::size_t i) {
    std::size_t x = orientation.columns ? line : i;
    std::size_t y = orientation.columns ? i : line;
    if (orientation.x_reversed) x = image.width - 1 - x;
    if (orientation.y_reversed) y = image.height - 1 - y;
    return y * image.width + x;
}

Result<LoadedImage> decode(std::span<const std::byte> bytes, std::string_view name, const HdrHeader& header) {
    // Refuse a file that is too short for its size, before allocating.
    const auto width = static_cast<std::size_t>(header.width), height = static_cast<std::size_t>(header.height);
    const std::size_t lines = header.orientation.columns ? width : height;
    const std::size_t length = header.orientation.columns ? height : width;
    Cursor in(bytes, header.end);
    if (in.remaining() / least_scanline_bytes(length) < lines)
        return Error{fmt::format("{}: the file ends too early: {} bytes after the header cannot hold {} x {} pixels",
                                 name, in.remaining(), width, height)};

    // Decode each scanline into its row or column.
    LoadedImage loaded{Image(width, height), header.warnings, {}};
    const TexelDecoder rgb(header);
    std::vector<StoredTexel> line(length);
    for (std::size_t l = 0; l < lines; ++l) {
        if (const Problem problem = decode_scanline(in, line))
            return Error{fmt::format("{}: {}, at byte {} (scanline {} of {})", name, *problem, in.offset(), l, lines)};
        for (std::size_t i = 0; i < length; ++i)
            loaded.image.pixels[pixel_index(loaded.image, header.orientation, l, i)] = rgb(line[i]);
    }
    if (in.remaining() > 0)
        loaded.warnings.push_back(fmt::format("{} bytes after the last scanline were ignored", in.remaining()));
    return loaded;
}

}  // namespace

Result<LoadedImage> read_hdr(std::span<const std::byte> bytes, std::string_view name, const ReadOptions& options) {
    const Result<HdrHeader> header = io::parse_hdr_header(bytes, name);
    if (!header) return header.error();
    if (const Status status = io::check_size(name, header->width, header->height, options); !status)
        return status.error();
    Result<LoadedImage> loaded = decode(bytes, name, *header);
    if (!loaded) return loaded;
    if (header->encoding == HdrHeader::Encoding::xyze) {
        loaded->warnings.push_back(
            fmt::format("XYZE pixels are taken as candela per square metre, and divided by {} lm/W", k_white_efficacy));
        io::clip_negatives(*loaded, "they lie outside the gamut of Rec. 709");
    }
    return io::inspected(std::move(*loaded), name, options);
}

}  // namespace lobelia
