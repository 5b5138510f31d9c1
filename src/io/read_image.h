// Environments from files: Radiance .hdr, OpenEXR and, where asked for, 8- and 16-bit pictures. Safe on any bytes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lobelia/image.h"
#include "lobelia/result.h"

namespace lobelia {

struct ReadOptions {
    /// Accept PNG, JPEG and BMP too, decoded from sRGB to linear: their white is 1, so suns and lamps are cut off.
    bool ldr = false;
    /// Replace NaN, infinite and negative components by 0 and count them, where otherwise they are an error.
    bool sanitize = false;
    /// Larger images are refused before anything is allocated for them.
    std::size_t most_pixels = std::size_t{1} << 28;
};

/// How many pixels hold a component that is no radiance; one pixel counts once, in the first class that fits.
struct BadPixels {
    std::size_t nan = 0, infinite = 0, negative = 0;
    [[nodiscard]] std::size_t total() const { return nan + infinite + negative; }
};

/// An image whose components are all finite and not negative, and what its reader had to say about the file.
struct LoadedImage {
    Image image;
    std::vector<std::string> warnings;
    BadPixels sanitized;
};

/// Reads an environment; the content, not the name, decides the format. Errors name the file, the place in it and what
/// to do. OpenEXR files are read in place (the image is all that is held); others are held in memory while decoded.
[[nodiscard]] Result<LoadedImage> read_environment(const std::filesystem::path& path, const ReadOptions& options = {});

/// The same for a file of any of the formats that is in memory already; `name` is what messages call it.
[[nodiscard]] Result<LoadedImage> read_environment(std::span<const std::byte> bytes, std::string_view name,
                                                   const ReadOptions& options = {});

/// Radiance .hdr (RGBE or XYZE): every orientation and run-length scheme. Exposure and colour correction are divided
/// out, so values are radiances as far as the file knows them. XYZE is taken as Radiance writes it, in candela per
/// square metre, and is adapted (Bradford) from its white, equal energy unless the file says otherwise, to D65.
[[nodiscard]] Result<LoadedImage> read_hdr(std::span<const std::byte> bytes, std::string_view name,
                                           const ReadOptions& options = {});

/// OpenEXR: RGB, luminance, or luminance with chroma, of the first part that has them; scan lines or tiles (level 0).
/// Negative components of a file with lossy compression (B44, DWA) become 0 with a warning: it makes them of zeros.
/// Decompression uses the threads that the application has given to OpenEXR (allow_reader_threads), 0 at first.
[[nodiscard]] Result<LoadedImage> read_exr(std::span<const std::byte> bytes, std::string_view name,
                                           const ReadOptions& options = {});

/// Gives OpenEXR a pool of `count` threads for the whole process.
void allow_reader_threads(int count);

/// PNG, JPEG or BMP, decoded from sRGB; an error unless options.ldr.
[[nodiscard]] Result<LoadedImage> read_ldr(std::span<const std::byte> bytes, std::string_view name,
                                           const ReadOptions& options = {});

}  // namespace lobelia
