// Small PNG, JPEG and WebP files of every kind, made in memory for the tests and as seeds for the fuzzers.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace lobelia {

/// Red, green, blue, alpha; row by row from the top left.
struct TestPicture {
    std::size_t width = 0, height = 0;
    std::vector<std::array<std::uint8_t, 4>> texels;
};

/// Colours that vary by a few levels between neighbours; alpha varies, too, if `transparent`.
enum class Alpha { opaque, transparent };
[[nodiscard]] TestPicture test_picture(std::size_t width, std::size_t height, Alpha alpha = Alpha::opaque);

struct PngSpec {
    enum class Colours { grey, grey_alpha, palette, rgb, rgba };
    Colours colours = Colours::rgb;
    int bits = 8;  ///< a sample, or an index of the palette
    bool interlaced = false;
    bool transparent = false;  ///< with a chunk tRNS: sample 1 (grey, RGB) or a list of alphas (palette)
};
struct PngFile {
    std::string bytes;
    TestPicture picture;  ///< 8 bits a sample; the upper 8 of 16
};
/// Stores samples that take all values of `bits`.
[[nodiscard]] PngFile make_png(std::size_t width, std::size_t height, const PngSpec& spec = {});

struct JpegSpec {
    enum class Colours { grey, ycc, rgb, cmyk, ycck };
    Colours colours = Colours::ycc;
    enum class Scans { interleaved, by_component, progressive };
    Scans scans = Scans::interleaved;
    bool arithmetic = false;
    unsigned restart_interval = 0;
    bool adobe = true;  ///< adds an Adobe segment, for CMYK: 255 is no ink
};
/// Makes a JPEG without subsampling, quality 95. CMYK is made without black.
[[nodiscard]] std::string make_jpeg(const TestPicture& picture, const JpegSpec& spec = {});

struct WebpSpec {
    bool lossless = true;
};
[[nodiscard]] std::string make_webp(const TestPicture& picture, const WebpSpec& spec = {});
/// Returns the first bytes of an animation.
[[nodiscard]] std::string make_animated_webp();

/// Segments of a JPEG file: `code` is the second byte of the marker. Image data follows its segment of code 0xda.
struct JpegSegment {
    std::uint8_t code = 0;
    std::string bytes;  ///< with the marker, and with the image data
};
[[nodiscard]] std::vector<JpegSegment> split_jpeg(const std::string& bytes);
[[nodiscard]] std::string join_jpeg(const std::vector<JpegSegment>& segments);
/// Removes the segments of one kind.
[[nodiscard]] std::string jpeg_without(const std::string& bytes, std::uint8_t code);

}  // namespace lobelia
