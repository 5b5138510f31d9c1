// The report as a page; pictures as half floats.
#include "report/html.h"

#include <cassert>
#include <nlohmann/json.hpp>
#include <string_view>

#include "report/page/base64.h"
#include "report/page/page.h"

namespace lobelia {

namespace {

/// Writes a pixel's six bytes, little-endian halves, as eight characters; so no pixel ever needs padding.
void write_pixel(Rgb pixel, char* out) {
    const std::uint32_t r = half_from_float(pixel.r), g = half_from_float(pixel.g), b = half_from_float(pixel.b);
    write_base64((r & 0xff) << 16 | (r >> 8) << 8 | (g & 0xff), out);
    write_base64((g >> 8) << 16 | (b & 0xff) << 8 | b >> 8, out + 4);
}

template <class PixelAt>
Picture encode(std::size_t width, std::size_t height, const PixelAt& pixel_at) {
    Picture picture{width, height, std::string(width * height * 8, '\0')};
    for (std::size_t i = 0; i < width * height; ++i) write_pixel(pixel_at(i), picture.base64_half.data() + i * 8);
    return picture;
}

/// Appends JSON by hand: base64 needs no escapes, and 12 MB of it should be copied once.
class PictureWriter {
  public:
    explicit PictureWriter(std::string& out) : out_(out) {}

    void write(const PictureSet& set) {
        out_ += "{\"references\":";
        write_map(set.references, [this](const PictureSet::Reference& r) {
            out_ += "{\"radiance\":";
            write(r.radiance);
            out_ += ",\"irradiance_over_pi\":";
            write(r.irradiance_over_pi);
            out_ += '}';
        });
        out_ += ",\n\"radiance\":";
        write_map(set.radiance, [this](const Picture& p) { write(p); });
        out_ += ",\n\"irradiance_over_pi\":";
        write_map(set.irradiance_over_pi, [this](const Picture& p) { write(p); });
        out_ += '}';
    }

  private:
    template <class Value, class Write>
    void write_map(const std::map<std::string, Value>& map, const Write& write_value) {
        char separator = '{';
        for (const auto& [name, value] : map) {
            ((out_ += separator) += '\n') += script_safe(name);
            out_ += ':';
            write_value(value);
            separator = ',';
        }
        out_ += map.empty() ? "{}" : "}";
    }

    void write(const Picture& p) {
        assert(p.base64_half.size() == p.width * p.height * 8);
        out_ += "{\"width\":" + std::to_string(p.width) + ",\"height\":" + std::to_string(p.height) + ",\"half\":\"";
        out_ += p.base64_half;
        out_ += "\"}";
    }

    std::string& out_;
};

std::size_t bytes_of(const PictureSet& set) {
    constexpr std::size_t around = 128;  // its name and its sizes
    std::size_t total = 0;
    const auto count = [&](const Picture& p) { total += p.base64_half.size() + around; };
    for (const auto& [name, r] : set.references) count(r.radiance), count(r.irradiance_over_pi);
    for (const auto& [name, p] : set.radiance) count(p);
    for (const auto& [name, p] : set.irradiance_over_pi) count(p);
    return total;
}

}  // namespace

Picture encode_picture(std::span<const Rgb> pixels, std::size_t width, std::size_t height) {
    assert(pixels.size() == width * height);
    return encode(width, height, [&](std::size_t i) { return pixels[i]; });
}

Picture encode_picture(const ColourView& pixels, std::size_t width, std::size_t height) {
    assert(pixels.size == width * height);
    return encode(width, height, [&](std::size_t i) { return colour_at(pixels, i); });
}

std::string report_html(const nlohmann::json& report, const PictureSet& pictures) {
    const std::string data = script_safe(report);
    return filled_page("report.html", data.size() + bytes_of(pictures), [&](std::string_view mark, std::string& html) {
        if (mark == "report")
            html += data;
        else if (mark == "pictures")
            PictureWriter(html).write(pictures);
        else
            return false;
        return true;
    });
}

}  // namespace lobelia
