// Environments from files: Radiance .hdr, OpenEXR and, if asked for, 8- and 16-bit pictures. Safe on any bytes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/read_file.h"
#include "lobelia/image.h"
#include "lobelia/result.h"

namespace lobelia {

struct ReadOptions {
    /// Accept PNG, JPEG and WebP too, decoded from sRGB to linear: their white is 1, so suns and lamps are cut off.
    bool ldr = false;
    /// Replace NaN, infinite and negative components by 0 and count them, instead of an error.
    bool sanitize = false;
    /// Larger images are refused before anything is allocated for them.
    std::size_t most_pixels = std::size_t{1} << 28;
};

/// Number of pixels with an invalid component; each pixel counts once, in the first class that applies.
struct BadPixels {
    std::size_t nan = 0, infinite = 0, negative = 0;
    [[nodiscard]] std::size_t total() const { return nan + infinite + negative; }
};

/// An image whose components are all finite and not negative, with the reader's warnings about the file.
struct LoadedImage {
    Image image;
    std::vector<std::string> warnings;
    BadPixels sanitized;
};

/// Reads an environment from a regular file; the content, not the name, decides the format. Errors name the file, the
/// place in it and what to do. OpenEXR files are read in place (only the image is held in memory); others are held in
/// memory while they are decoded.
[[nodiscard]] Result<LoadedImage> read_environment(const std::filesystem::path& path, const ReadOptions& options = {});

/// Reads a file of any of the formats that is in memory already; messages call it `name`.
[[nodiscard]] Result<LoadedImage> read_environment(std::span<const std::byte> bytes, std::string_view name,
                                                   const ReadOptions& options = {});

/// Reads Radiance .hdr (RGBE or XYZE): every orientation and run-length scheme. Exposure and colour correction are
/// divided out, so values are radiances as far as the file knows them. XYZE is taken as Radiance writes it, in candela
/// per square metre, and is adapted (Bradford) from its white, equal energy unless the file says otherwise, to D65.
[[nodiscard]] Result<LoadedImage> read_hdr(std::span<const std::byte> bytes, std::string_view name,
                                           const ReadOptions& options = {});

/// Reads OpenEXR: RGB, luminance, or luminance with chroma, of the first part that has them; scan lines or tiles (level
/// 0). The image is the display window, black where no pixels are stored; the attribute envmap is obeyed, cubes are
/// converted. Negative components of a file with lossy compression (B44, DWA) become 0 with a warning: it makes them of
/// zeros. Decompression uses the threads given to OpenEXR by allow_reader_threads, 0 at first.
[[nodiscard]] Result<LoadedImage> read_exr(std::span<const std::byte> bytes, std::string_view name,
                                           const ReadOptions& options = {});
[[nodiscard]] Result<LoadedImage> read_exr(InputFile file, const ReadOptions& options = {});

/// Gives OpenEXR a pool of `count` threads for the whole process.
void allow_reader_threads(int count);

/// Reads PNG, JPEG or WebP, decoded from sRGB, without alpha; an error unless options.ldr.
[[nodiscard]] Result<LoadedImage> read_ldr(std::span<const std::byte> bytes, std::string_view name,
                                           const ReadOptions& options = {});

}  // namespace lobelia
