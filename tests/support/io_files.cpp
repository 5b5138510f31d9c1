// Small image files of every supported kind, made in memory for the tests and as seeds for the fuzzers.
#include "io_files.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfTiledOutputFile.h>

#include <algorithm>
#include <cstring>

#include "io/exr_stream.h"

namespace lobelia {

namespace {

using HdrTexel = HdrTexels::Texel;

void append(std::string& bytes, const HdrTexel& texel) {
    for (const std::uint8_t b : texel) bytes.push_back(static_cast<char>(b));
}

/// Returns how often the entry at `i` repeats, up to `most`.
template <class Equal>
std::size_t run_length(std::size_t i, std::size_t size, std::size_t most, const Equal& equal) {
    std::size_t length = 1;
    while (i + length < size && length < most && equal(i, i + length)) ++length;
    return length;
}

void append_old_rle(std::string& bytes, const std::vector<HdrTexel>& line) {
    for (std::size_t i = 0; i < line.size();) {
        append(bytes, line[i]);
        std::size_t repeats =
            run_length(i, line.size(), line.size(), [&](auto a, auto b) { return line[a] == line[b]; }) - 1;
        i += 1 + repeats;
        for (; repeats > 0; repeats /= 256) append(bytes, {1, 1, 1, static_cast<std::uint8_t>(repeats % 256)});
    }
}

void append_new_rle(std::string& bytes, const std::vector<HdrTexel>& line) {
    append(bytes, {2, 2, static_cast<std::uint8_t>(line.size() / 256), static_cast<std::uint8_t>(line.size() % 256)});
    for (std::size_t c = 0; c < 4; ++c) {
        for (std::size_t i = 0; i < line.size();) {
            const std::size_t run =
                run_length(i, line.size(), 127, [&](auto a, auto b) { return line[a][c] == line[b][c]; });
            bytes.push_back(static_cast<char>(run > 1 ? 128 + run : 1));
            bytes.push_back(static_cast<char>(line[i][c]));
            i += run;
        }
    }
}

/// Returns the scanlines of a picture in the order of `axes`.
std::vector<std::vector<HdrTexel>> scanlines(const HdrTexels& picture, const std::string& axes) {
    const bool columns = axes[1] == 'X';
    const bool left = axes[columns ? 0 : 3] == '-', up = axes[columns ? 3 : 0] == '+';
    std::vector<std::vector<HdrTexel>> lines(columns ? picture.width : picture.height);
    for (std::size_t l = 0; l < lines.size(); ++l) {
        for (std::size_t i = 0; i < (columns ? picture.height : picture.width); ++i) {
            const std::size_t x = columns ? l : i, y = columns ? i : l;
            const std::size_t column = left ? picture.width - 1 - x : x, row = up ? picture.height - 1 - y : y;
            lines[l].push_back(picture.texels[row * picture.width + column]);
        }
    }
    return lines;
}

/// The samples of all channels in one pixel type, and the frame buffer that points at them.
class StoredPlanes {
  public:
    StoredPlanes(const Image& image, const ExrSpec& spec) : bytes_(spec.channels.size()) {
        const std::size_t size = spec.type == Imf::HALF ? 2 : 4;
        for (std::size_t c = 0; c < bytes_.size(); ++c) {
            for (const Rgb& pixel : image.pixels)
                append_sample(c, spec.type, std::array{pixel.r, pixel.g, pixel.b}[c % 3]);
            // Origins are multiples of bytes, so a plain offset is enough.
            const std::ptrdiff_t origin = (spec.top * static_cast<std::ptrdiff_t>(image.width) + spec.left) * size;
            buffer_.insert(spec.channels[c],
                           Imf::Slice(spec.type, bytes_[c].data() - origin, size, size * image.width));
        }
    }
    [[nodiscard]] const Imf::FrameBuffer& buffer() const { return buffer_; }

  private:
    void append_sample(std::size_t c, Imf::PixelType type, float value) {
        const half h(value);
        const auto u = static_cast<std::uint32_t>(value);
        const void* source = type == Imf::HALF   ? static_cast<const void*>(&h)
                             : type == Imf::UINT ? static_cast<const void*>(&u)
                                                 : static_cast<const void*>(&value);
        bytes_[c].append(static_cast<const char*>(source), type == Imf::HALF ? 2 : 4);
    }

    std::vector<std::string> bytes_;
    Imf::FrameBuffer buffer_;
};

Imf::Header header_of(const Image& image, const ExrSpec& spec) {
    Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
    header.compression() = spec.compression;
    header.dataWindow().min.x += spec.left;
    header.dataWindow().max.x += spec.left;
    header.dataWindow().min.y += spec.top;
    header.dataWindow().max.y += spec.top;
    header.displayWindow() = header.dataWindow();
    if (spec.display) {
        const auto& [left, top, right, bottom] = *spec.display;
        header.displayWindow() = Imath::Box2i({left, top}, {right, bottom});
    }
    if (spec.envmap) Imf::addEnvmap(header, *spec.envmap);
    for (const std::string& channel : spec.channels) header.channels().insert(channel, Imf::Channel(spec.type));
    return header;
}

void write_tiles(Imf::OStream& out, Imf::Header header, const ExrSpec& spec, const Imf::FrameBuffer& source) {
    const Imf::LevelMode mode = spec.layout == ExrSpec::Layout::mipmap   ? Imf::MIPMAP_LEVELS
                                : spec.layout == ExrSpec::Layout::ripmap ? Imf::RIPMAP_LEVELS
                                                                         : Imf::ONE_LEVEL;
    header.setTileDescription(Imf::TileDescription(8, 4, mode));
    Imf::TiledOutputFile file(out, header);
    file.setFrameBuffer(source);
    for (int ly = 0; ly < file.numYLevels(); ++ly)
        for (int lx = 0; lx < file.numXLevels(); ++lx)
            if (file.isValidLevel(lx, ly))
                file.writeTiles(0, file.numXTiles(lx) - 1, 0, file.numYTiles(ly) - 1, lx, ly);
}

}  // namespace

HdrTexels test_texels(std::size_t width, std::size_t height) {
    HdrTexels picture{width, height, {}};
    for (std::size_t i = 0; i < width * height; ++i) {
        const std::size_t x = i % width, y = i / width;
        // Half of the texels lie in runs; mantissas are normalised, as every writer does.
        const std::size_t v = x % 16 < 8 ? x / 16 : x;
        const auto byte = [](std::size_t b) { return static_cast<std::uint8_t>(b); };
        HdrTexel texel{byte(128 + (v * 7 + y * 3) % 128), byte((v * 31 + y) % 256), byte((v + y * 17) % 256),
                       byte(120 + (v + y) % 20)};
        if ((x + y) % 11 == 5) texel = {0, 0, 0, 0};
        picture.texels.push_back(texel);
    }
    return picture;
}

std::string make_hdr(const HdrTexels& picture, const HdrSpec& spec) {
    const bool columns = spec.axes[1] == 'X';
    const auto sizes = columns ? std::array{picture.width, picture.height} : std::array{picture.height, picture.width};
    std::string bytes = "#?RADIANCE\n" + spec.variables + "\n" + spec.axes.substr(0, 2) + " " +
                        std::to_string(sizes[0]) + " " + spec.axes.substr(3, 2) + " " + std::to_string(sizes[1]) + "\n";
    for (const std::vector<HdrTexel>& line : scanlines(picture, spec.axes)) {
        switch (spec.scheme) {
            case HdrSpec::Scheme::flat:
                for (const HdrTexel& texel : line) append(bytes, texel);
                break;
            case HdrSpec::Scheme::old_rle:
                append_old_rle(bytes, line);
                break;
            case HdrSpec::Scheme::new_rle:
                append_new_rle(bytes, line);
                break;
        }
    }
    return bytes;
}

Image test_image(std::size_t width, std::size_t height) {
    Image image(width, height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const auto value = [i](std::size_t a) { return static_cast<float>(32 + (i * a + i / 7) % 29); };
        image.pixels[i] = {value(1), value(5), value(11)};
    }
    return image;
}

std::string make_exr(const Image& image, const ExrSpec& spec) {
    const StoredPlanes planes(image, spec);
    const Imf::Header header = header_of(image, spec);
    io::MemoryOutput out("test");
    if (spec.layout == ExrSpec::Layout::scan_lines) {
        Imf::OutputFile file(out, header);
        file.setFrameBuffer(planes.buffer());
        file.writePixels(static_cast<int>(image.height));
    } else {
        write_tiles(out, header, spec, planes.buffer());
    }
    return out.take();
}

std::string make_luminance_chroma_exr(const Image& image) {
    io::MemoryOutput out("test");
    {
        const Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
        Imf::RgbaOutputFile file(out, header, Imf::WRITE_YC);
        std::vector<Imf::Rgba> pixels;
        for (const Rgb& p : image.pixels) pixels.emplace_back(p.r, p.g, p.b);
        file.setFrameBuffer(pixels.data(), 1, image.width);
        file.writePixels(static_cast<int>(image.height));
    }
    return out.take();
}

std::string make_multi_part_exr(const Image& image, const std::vector<std::vector<std::string>>& parts) {
    std::vector<Imf::Header> headers;
    std::vector<StoredPlanes> planes;
    for (const auto& channels : parts) {
        ExrSpec spec;
        spec.channels = channels;
        headers.push_back(header_of(image, spec));
        headers.back().setName("part " + std::to_string(headers.size() - 1));
        headers.back().setType(Imf::SCANLINEIMAGE);
        planes.emplace_back(image, spec);
    }
    io::MemoryOutput out("test");
    {
        Imf::MultiPartOutputFile file(out, headers.data(), static_cast<int>(headers.size()));
        for (std::size_t p = 0; p < parts.size(); ++p) {
            Imf::OutputPart part(file, static_cast<int>(p));
            part.setFrameBuffer(planes[p].buffer());
            part.writePixels(static_cast<int>(image.height));
        }
    }
    return out.take();
}

std::string make_deep_exr() {
    constexpr int k_side = 4;
    Imf::Header header(k_side, k_side);
    header.channels().insert("R", Imf::Channel(Imf::FLOAT));
    header.setType(Imf::DEEPSCANLINE);
    header.compression() = Imf::ZIPS_COMPRESSION;
    io::MemoryOutput out("test");
    {
        Imf::DeepScanLineOutputFile file(out, header);
        std::array<std::uint32_t, k_side * k_side> counts;
        counts.fill(1);
        std::array<float, k_side * k_side> values{};
        std::array<float*, k_side * k_side> pointers{};
        for (std::size_t i = 0; i < values.size(); ++i) pointers[i] = &values[i];
        Imf::DeepFrameBuffer source;
        source.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data()), 4, 4 * k_side));
        source.insert("R", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(pointers.data()), sizeof(float*),
                                          sizeof(float*) * k_side, sizeof(float)));
        file.setFrameBuffer(source);
        file.writePixels(k_side);
    }
    return out.take();
}

}  // namespace lobelia
