// Small PNG, JPEG and WebP files. Errors of the libraries end the program, because these files are valid.
#include "picture_files.h"

#include <png.h>
#include <webp/encode.h>

#include <cstdio>
#include <cstdlib>
// jpeglib.h needs FILE before it.
#include <jpeglib.h>

#include <algorithm>

namespace lobelia {

namespace {

std::uint8_t byte(std::size_t value) { return static_cast<std::uint8_t>(value); }

/// Returns a sample of `bits` bits; takes all values over a picture, including neighbouring ones.
std::uint16_t test_sample(std::size_t x, std::size_t y, std::size_t channel, int bits) {
    return static_cast<std::uint16_t>((x * 2654435761u + y * 40503u + channel * 977u + (x >> 3) * 31u) >> 3 &
                                      ((1u << bits) - 1));
}

int channels_of(PngSpec::Colours colours) {
    switch (colours) {
        case PngSpec::Colours::grey:
        case PngSpec::Colours::palette:
            return 1;
        case PngSpec::Colours::grey_alpha:
            return 2;
        case PngSpec::Colours::rgb:
            return 3;
        case PngSpec::Colours::rgba:
            break;
    }
    return 4;
}

int png_type(PngSpec::Colours colours) {
    switch (colours) {
        case PngSpec::Colours::grey:
            return PNG_COLOR_TYPE_GRAY;
        case PngSpec::Colours::palette:
            return PNG_COLOR_TYPE_PALETTE;
        case PngSpec::Colours::grey_alpha:
            return PNG_COLOR_TYPE_GRAY_ALPHA;
        case PngSpec::Colours::rgb:
            return PNG_COLOR_TYPE_RGB;
        case PngSpec::Colours::rgba:
            break;
    }
    return PNG_COLOR_TYPE_RGB_ALPHA;
}

png_color palette_entry(std::size_t i) { return {byte(i * 5), byte(255 - i), byte(i * 3)}; }

/// Samples of a pixel, as stored.
std::array<std::uint16_t, 4> png_samples(std::size_t x, std::size_t y, const PngSpec& spec) {
    std::array<std::uint16_t, 4> samples{};
    for (int c = 0; c < channels_of(spec.colours); ++c)
        samples[static_cast<std::size_t>(c)] = test_sample(x, y, static_cast<std::size_t>(c), spec.bits);
    return samples;
}

/// The colour that a reader returns for them.
std::array<std::uint8_t, 4> png_texel(const std::array<std::uint16_t, 4>& samples, const PngSpec& spec) {
    const auto level = [&](std::uint16_t sample) {
        return spec.bits == 16 ? byte(sample >> 8) : byte(sample * 255u / ((1u << spec.bits) - 1));
    };
    const auto& s = samples;
    switch (spec.colours) {
        case PngSpec::Colours::grey: {
            const std::uint8_t alpha = spec.transparent && s[0] == 1 ? 0 : 255;
            return {level(s[0]), level(s[0]), level(s[0]), alpha};
        }
        case PngSpec::Colours::grey_alpha:
            return {level(s[0]), level(s[0]), level(s[0]), level(s[1])};
        case PngSpec::Colours::palette: {
            const png_color c = palette_entry(s[0]);
            return {c.red, c.green, c.blue, spec.transparent ? byte(s[0]) : std::uint8_t{255}};
        }
        case PngSpec::Colours::rgb: {
            const std::uint8_t alpha = spec.transparent && s[0] == 1 && s[1] == 1 && s[2] == 1 ? 0 : 255;
            return {level(s[0]), level(s[1]), level(s[2]), alpha};
        }
        case PngSpec::Colours::rgba:
            break;
    }
    return {level(s[0]), level(s[1]), level(s[2]), level(s[3])};
}

std::vector<std::uint8_t> packed_row(const std::vector<std::uint16_t>& samples, int bits) {
    std::vector<std::uint8_t> row((samples.size() * static_cast<std::size_t>(bits) + 7) / 8);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const std::size_t bit = i * static_cast<std::size_t>(bits);
        if (bits == 16) {
            row[2 * i] = byte(samples[i] >> 8);
            row[2 * i + 1] = byte(samples[i]);
        } else {
            row[bit / 8] = byte(row[bit / 8] | samples[i] << (8 - static_cast<std::size_t>(bits) - bit % 8));
        }
    }
    return row;
}

void set_transparency(png_structp png, png_infop info, const PngSpec& spec) {
    if (!spec.transparent) return;
    std::array<png_byte, 256> alphas{};
    for (std::size_t i = 0; i < alphas.size(); ++i) alphas[i] = byte(i);
    png_color_16 key{0, 1, 1, 1, 1};
    const int count = spec.colours == PngSpec::Colours::palette ? 1 << spec.bits : 1;
    png_set_tRNS(png, info, alphas.data(), count, &key);
}

void put_bytes(png_structp png, png_bytep data, std::size_t size) {
    static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(data), size);
}

J_COLOR_SPACE stored_space(JpegSpec::Colours colours) {
    switch (colours) {
        case JpegSpec::Colours::grey:
            return JCS_GRAYSCALE;
        case JpegSpec::Colours::ycc:
            return JCS_YCbCr;
        case JpegSpec::Colours::rgb:
            return JCS_RGB;
        case JpegSpec::Colours::cmyk:
            return JCS_CMYK;
        case JpegSpec::Colours::ycck:
            break;
    }
    return JCS_YCCK;
}

/// Adds a scan for each component, with all its coefficients.
std::vector<jpeg_scan_info> component_scans(int components) {
    std::vector<jpeg_scan_info> scans;
    for (int c = 0; c < components; ++c) scans.push_back({1, {c, 0, 0, 0}, 0, 63, 0, 0});
    return scans;
}

}  // namespace

TestPicture test_picture(std::size_t width, std::size_t height, Alpha alpha) {
    TestPicture picture{width, height, {}};
    for (std::size_t i = 0; i < width * height; ++i) {
        const std::size_t x = i % width, y = i / width;
        picture.texels.push_back({byte(40 + (x * 3) % 160), byte(60 + (y * 5) % 120), byte(90 + (x + y) % 100),
                                  alpha == Alpha::transparent ? byte(255 - (x + y) % 200) : std::uint8_t{255}});
    }
    return picture;
}

PngFile make_png(std::size_t width, std::size_t height, const PngSpec& spec) {
    PngFile file{"", {width, height, {}}};
    std::vector<std::vector<std::uint8_t>> rows;
    for (std::size_t y = 0; y < height; ++y) {
        std::vector<std::uint16_t> samples;
        for (std::size_t x = 0; x < width; ++x) {
            const auto pixel = png_samples(x, y, spec);
            samples.insert(samples.end(), pixel.begin(), pixel.begin() + channels_of(spec.colours));
            file.picture.texels.push_back(png_texel(pixel, spec));
        }
        rows.push_back(packed_row(samples, spec.bits));
    }

    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(png, &file.bytes, put_bytes, nullptr);
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), spec.bits,
                 png_type(spec.colours), spec.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    std::array<png_color, 256> palette{};
    for (std::size_t i = 0; i < palette.size(); ++i) palette[i] = palette_entry(i);
    if (spec.colours == PngSpec::Colours::palette) png_set_PLTE(png, info, palette.data(), 1 << spec.bits);
    set_transparency(png, info, spec);
    std::vector<png_bytep> pointers;
    for (auto& row : rows) pointers.push_back(row.data());
    png_set_rows(png, info, pointers.data());
    png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
    png_destroy_write_struct(&png, &info);
    return file;
}

std::string make_jpeg(const TestPicture& picture, const JpegSpec& spec) {
    jpeg_compress_struct codec{};
    jpeg_error_mgr errors{};
    codec.err = jpeg_std_error(&errors);
    jpeg_create_compress(&codec);
    unsigned char* memory = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&codec, &memory, &size);
    codec.image_width = static_cast<JDIMENSION>(picture.width);
    codec.image_height = static_cast<JDIMENSION>(picture.height);
    const bool inks = spec.colours == JpegSpec::Colours::cmyk || spec.colours == JpegSpec::Colours::ycck;
    codec.input_components = 4;
    codec.in_color_space = inks ? JCS_CMYK : JCS_EXT_RGBX;
    jpeg_set_defaults(&codec);
    jpeg_set_colorspace(&codec, stored_space(spec.colours));
    for (int c = 0; c < codec.num_components; ++c)
        codec.comp_info[c].h_samp_factor = codec.comp_info[c].v_samp_factor = 1;
    jpeg_set_quality(&codec, 95, TRUE);
    codec.arith_code = spec.arithmetic ? TRUE : FALSE;
    codec.restart_interval = spec.restart_interval;
    const auto scans = component_scans(codec.num_components);
    if (spec.scans == JpegSpec::Scans::progressive) jpeg_simple_progression(&codec);
    if (spec.scans == JpegSpec::Scans::by_component) {
        codec.scan_info = scans.data();
        codec.num_scans = static_cast<int>(scans.size());
    }
    if (inks) codec.write_Adobe_marker = spec.adobe ? TRUE : FALSE;

    jpeg_start_compress(&codec, TRUE);
    std::vector<std::array<std::uint8_t, 4>> row(picture.width);
    for (std::size_t y = 0; y < picture.height; ++y) {
        std::copy_n(picture.texels.begin() + static_cast<std::ptrdiff_t>(y * picture.width), picture.width,
                    row.begin());
        // No black: cyan, magenta and yellow are red, green and blue, or their complements.
        if (inks)
            for (auto& texel : row)
                for (std::size_t c = 0; c < 4; ++c)
                    texel[c] = byte((c == 3 ? 255u : texel[c]) ^ (spec.adobe ? 0u : 255u));
        JSAMPROW pointer = row.data()->data();
        jpeg_write_scanlines(&codec, &pointer, 1);
    }
    jpeg_finish_compress(&codec);
    std::string bytes(reinterpret_cast<const char*>(memory), size);
    std::free(memory);
    jpeg_destroy_compress(&codec);
    return bytes;
}

std::string make_webp(const TestPicture& picture, const WebpSpec& spec) {
    const int width = static_cast<int>(picture.width), height = static_cast<int>(picture.height);
    const std::uint8_t* texels = picture.texels.data()->data();
    std::uint8_t* memory = nullptr;
    const std::size_t size = spec.lossless ? WebPEncodeLosslessRGBA(texels, width, height, 4 * width, &memory)
                                           : WebPEncodeRGBA(texels, width, height, 4 * width, 90, &memory);
    std::string bytes(reinterpret_cast<const char*>(memory), size);
    WebPFree(memory);
    return bytes;
}

std::string make_animated_webp() {
    using namespace std::string_literals;
    // A chunk VP8X with the flag of animations, and a canvas of 16 x 8.
    return "RIFF\x20\0\0\0WEBPVP8X\x0a\0\0\0\x02\0\0\0\x0f\0\0\x07\0\0ANIM\x06\0\0\0\0\0\0\0\0\0"s;
}

std::vector<JpegSegment> split_jpeg(const std::string& bytes) {
    const auto at = [&](std::size_t i) { return static_cast<std::uint8_t>(bytes[i]); };
    std::vector<JpegSegment> segments;
    for (std::size_t begin = 0; begin + 1 < bytes.size();) {
        const std::uint8_t code = at(begin + 1);
        std::size_t end = begin + 2;
        if (code != 0xd8 && code != 0xd9) end += at(end) * 256u + at(end + 1);
        // Image data continues to the next marker that is not a restart marker.
        if (code == 0xda)
            while (end + 1 < bytes.size() &&
                   (at(end) != 0xff || at(end + 1) == 0 || (at(end + 1) >= 0xd0 && at(end + 1) <= 0xd7)))
                ++end;
        segments.push_back({code, bytes.substr(begin, end - begin)});
        begin = end;
    }
    return segments;
}

std::string join_jpeg(const std::vector<JpegSegment>& segments) {
    std::string bytes;
    for (const JpegSegment& segment : segments) bytes += segment.bytes;
    return bytes;
}

std::string jpeg_without(const std::string& bytes, std::uint8_t code) {
    auto segments = split_jpeg(bytes);
    std::erase_if(segments, [&](const JpegSegment& s) { return s.code == code; });
    return join_jpeg(segments);
}

}  // namespace lobelia
