// Small image files of every supported kind, made in memory for the tests and as seeds for the fuzzers.
#pragma once

#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/ImfEnvmap.h>
#include <OpenEXR/ImfPixelType.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lobelia/image.h"

namespace lobelia {

/// A picture of stored Radiance texels, row by row from the top left.
struct HdrTexels {
    using Texel = std::array<std::uint8_t, 4>;
    std::size_t width = 0, height = 0;
    std::vector<Texel> texels;
};

/// Texels with runs in them, and some black ones.
[[nodiscard]] HdrTexels test_texels(std::size_t width, std::size_t height);

struct HdrSpec {
    enum class Scheme { flat, old_rle, new_rle };
    Scheme scheme = Scheme::new_rle;
    /// Signs and order of the resolution line: "-Y +X" is the usual one, "+X -Y" goes column by column.
    std::string axes = "-Y +X";
    /// Header lines, each with its '\n'.
    std::string variables = "FORMAT=32-bit_rle_rgbe\n";
};
[[nodiscard]] std::string make_hdr(const HdrTexels& picture, const HdrSpec& spec = {});

/// An image of whole numbers from 32 to 60, which every pixel type of OpenEXR holds.
[[nodiscard]] Image test_image(std::size_t width, std::size_t height);

struct ExrSpec {
    enum class Layout { scan_lines, tiles, mipmap, ripmap };
    Layout layout = Layout::scan_lines;
    Imf::Compression compression = Imf::ZIP_COMPRESSION;
    Imf::PixelType type = Imf::HALF;
    /// Channel k holds the image's component k % 3.
    std::vector<std::string> channels{"R", "G", "B"};
    /// The data window's upper left corner.
    int left = 0, top = 0;
    /// Left, top, right and bottom (included) of the display window; absent: the data window.
    std::optional<std::array<int, 4>> display = std::nullopt;
    std::optional<Imf::Envmap> envmap = std::nullopt;
};
[[nodiscard]] std::string make_exr(const Image& image, const ExrSpec& spec = {});
/// Luminance with chroma at half rate.
[[nodiscard]] std::string make_luminance_chroma_exr(const Image& image);
/// One part for each list of channels, named "part 0" and so on.
[[nodiscard]] std::string make_multi_part_exr(const Image& image, const std::vector<std::vector<std::string>>& parts);
[[nodiscard]] std::string make_deep_exr();

}  // namespace lobelia
