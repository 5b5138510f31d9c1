// Images into files: OpenEXR with named float channels, and PNG pictures for people.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/math/colour.h"
#include "io/staged_file.h"
#include "lobelia/image.h"
#include "lobelia/result.h"

namespace lobelia {

struct ExrOptions {
    using Precision = lobelia::Precision;
    /// Half holds 11 bits; finite values beyond +-65504 are stored as that.
    Precision precision = Precision::full;
};

/// One channel of an OpenEXR file: pixel i, row by row from the top left, is data[i * stride].
struct ExrChannel {
    std::string name;
    std::span<const float> data;
    std::size_t stride = 1;
    std::optional<ExrOptions::Precision> precision = std::nullopt;  ///< default: that of the options
};

/// The bytes of a scan-line OpenEXR file (ZIP). Channels have distinct names and reach all width * height pixels.
[[nodiscard]] Result<std::string> encode_exr(std::size_t width, std::size_t height,
                                             std::span<const ExrChannel> channels, const ExrOptions& options = {});
/// The same with channels R, G, B.
[[nodiscard]] Result<std::string> encode_exr(const Image& image, const ExrOptions& options = {});
/// An error that names the first pixel that is NaN or infinite.
[[nodiscard]] Status check_finite(const Image& image);

/// The same into a file, written atomically; an error if a value is not finite.
[[nodiscard]] Status write_exr(const std::filesystem::path& path, const Image& image, const ExrOptions& options = {});
[[nodiscard]] Status write_exr(StagedFile& file, const Image& image, const ExrOptions& options = {});
/// Any channels into a file: rows go there as they are encoded, so that no second copy of a large image is in memory.
[[nodiscard]] Status write_exr(StagedFile& file, std::size_t width, std::size_t height,
                               std::span<const ExrChannel> channels, const ExrOptions& options = {});

/// A picture of 8-bit sRGB: red, green, blue, row by row from the top left.
struct Image8 {
    std::size_t width = 0;
    std::size_t height = 0;
    std::vector<std::uint8_t> rgb;
};

/// `image` times `exposure`, through the tone curve (NaN and negative values to 0) and the sRGB curve, and rounded.
[[nodiscard]] Image8 to_srgb(const Image& image, float exposure = 1, ToneCurve tone = ToneCurve::clamp);

/// The bytes of a PNG file.
[[nodiscard]] Result<std::string> encode_png(const Image8& picture);
/// The same with alpha, of texels as they are, red, green, blue, alpha.
[[nodiscard]] Result<std::string> encode_png(std::size_t width, std::size_t height,
                                             std::span<const std::array<std::uint8_t, 4>> texels);
/// The first into a file, written atomically.
[[nodiscard]] Status write_png(const std::filesystem::path& path, const Image8& picture);

}  // namespace lobelia
