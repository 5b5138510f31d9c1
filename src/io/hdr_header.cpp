// The text header of a Radiance picture, after Ward, "The RADIANCE Picture File Format" (1991, revised).
#include "io/hdr_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

namespace lobelia::io {

namespace {

using Primaries = std::array<double, 8>;
constexpr Primaries k_rec709{0.640, 0.330, 0.300, 0.600, 0.150, 0.060, 0.3127, 0.3290};
// Radiance's own default: its green is a little off Rec. 709's, and its white is equal energy.
constexpr Primaries k_radiance{0.640, 0.330, 0.290, 0.600, 0.150, 0.060, 1.0 / 3, 1.0 / 3};

/// Takes whitespace-separated words off a line.
class Words {
  public:
    explicit Words(std::string_view text) : rest_(text) {}
    [[nodiscard]] std::string_view next() {
        constexpr std::string_view k_space = " \t\r";
        rest_.remove_prefix(std::min(rest_.find_first_not_of(k_space), rest_.size()));
        const std::string_view word = rest_.substr(0, rest_.find_first_of(k_space));
        rest_.remove_prefix(word.size());
        return word;
    }

  private:
    std::string_view rest_;
};

template <class Number>
std::optional<Number> number(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size() || word.empty()) return std::nullopt;
    return value;
}

template <std::size_t N>
std::optional<std::array<double, N>> numbers(std::string_view text) {
    Words words(text);
    std::array<double, N> values{};
    for (double& value : values) {
        const std::optional<double> parsed = number<double>(words.next());
        if (!parsed || !std::isfinite(*parsed)) return std::nullopt;
        value = *parsed;
    }
    return words.next().empty() ? std::optional(values) : std::nullopt;
}

bool near(const Primaries& a, const Primaries& b) {
    return std::equal(a.begin(), a.end(), b.begin(), [](double x, double y) { return std::abs(x - y) < 0.002; });
}

/// Returns the text after `key` if `line` begins with it.
std::optional<std::string_view> value_of(std::string_view line, std::string_view key) {
    return line.starts_with(key) ? std::optional(line.substr(key.size())) : std::nullopt;
}

/// Iterates over the lines of the header, with their offsets. Lines end at '\n'; a '\r' before it is dropped.
class Lines {
  public:
    Lines(std::span<const std::byte> bytes, std::string_view name) : bytes_(bytes), name_(name) {}

    [[nodiscard]] std::size_t offset() const { return offset_; }
    [[nodiscard]] Result<std::string_view> next() {
        line_ = offset_;
        const auto begin = bytes_.begin() + static_cast<std::ptrdiff_t>(offset_);
        const auto end = std::find(begin, bytes_.end(), std::byte{'\n'});
        if (end == bytes_.end()) {
            line_ = bytes_.size();
            return error("the file ends within its header");
        }
        const auto length = static_cast<std::size_t>(end - begin);
        std::string_view line(reinterpret_cast<const char*>(bytes_.data()) + offset_, length);
        if (line.ends_with('\r')) line.remove_suffix(1);
        offset_ += length + 1;
        return line;
    }
    [[nodiscard]] Error error(std::string_view problem) const {
        return Error{fmt::format("{}: {}, at byte {}", name_, problem, line_)};
    }

  private:
    std::span<const std::byte> bytes_;
    std::string_view name_;
    std::size_t offset_ = 0;
    std::size_t line_ = 0;
};

Status apply_exposure(HdrHeader& header, const std::array<double, 3>& factors, const Lines& lines) {
    // Bound the product: its inverse multiplies texels of up to 2^127 in float.
    constexpr double k_least = 1e-30, k_most = 1e30;
    for (std::size_t i = 0; i < 3; ++i) {
        header.multiplier[i] *= factors[i];
        if (!(header.multiplier[i] >= k_least && header.multiplier[i] <= k_most))
            return lines.error(
                fmt::format("the exposure {} is outside {} to {}", header.multiplier[i], k_least, k_most));
    }
    return Done{};
}

Status apply_primaries(HdrHeader& header, std::string_view value, const Lines& lines) {
    const auto primaries = numbers<8>(value);
    if (!primaries) return lines.error("PRIMARIES is not eight numbers");
    // Some programs write zeros for unknown primaries.
    if (std::all_of(primaries->begin(), primaries->end(), [](double p) { return p == 0; })) return Done{};
    const Chromaticity white{(*primaries)[6], (*primaries)[7]};
    if (!(white.x > 0 && white.y > 0 && white.x + white.y < 1))
        return lines.error("the white of PRIMARIES is not a chromaticity");
    header.white = white;
    header.foreign_primaries = !near(*primaries, k_rec709) && !near(*primaries, k_radiance);
    return Done{};
}

Status apply_format(HdrHeader& header, std::string_view value, const Lines& lines) {
    const std::string_view format = Words(value).next();
    if (format == "32-bit_rle_rgbe")
        header.encoding = HdrHeader::Encoding::rgbe;
    else if (format == "32-bit_rle_xyze")
        header.encoding = HdrHeader::Encoding::xyze;
    else
        return lines.error(fmt::format("FORMAT is neither 32-bit_rle_rgbe nor 32-bit_rle_xyze"));
    return Done{};
}

/// Applies the variable of one line; unknown lines are ignored.
Status apply_line(HdrHeader& header, std::string_view line, const Lines& lines) {
    if (const auto value = value_of(line, "FORMAT=")) return apply_format(header, *value, lines);
    if (const auto value = value_of(line, "PRIMARIES=")) return apply_primaries(header, *value, lines);
    if (const auto value = value_of(line, "EXPOSURE=")) {
        const auto factor = numbers<1>(*value);
        if (!factor) return lines.error("EXPOSURE is not a number");
        return apply_exposure(header, {(*factor)[0], (*factor)[0], (*factor)[0]}, lines);
    }
    if (const auto value = value_of(line, "COLORCORR=")) {
        const auto factors = numbers<3>(*value);
        if (!factors) return lines.error("COLORCORR is not three numbers");
        return apply_exposure(header, *factors, lines);
    }
    return Done{};
}

Status apply_resolution(HdrHeader& header, std::string_view line, const Lines& lines) {
    Words words(line);
    const std::array<std::string_view, 2> axis_and_size[]{{words.next(), words.next()}, {words.next(), words.next()}};
    const Error malformed = lines.error("the resolution line is not of the form \"-Y height +X width\"");
    bool has_x = false, has_y = false;
    for (const auto& [axis, size] : axis_and_size) {
        const auto length = number<std::int64_t>(size);
        if (!length || axis.size() != 2 || (axis[0] != '+' && axis[0] != '-')) return malformed;
        if (axis[1] == 'X' && !has_x) {
            header.width = *length;
            header.orientation.x_reversed = axis[0] == '-';
            header.orientation.columns = !has_y;
            has_x = true;
        } else if (axis[1] == 'Y' && !has_y) {
            // Radiance's y grows upwards.
            header.height = *length;
            header.orientation.y_reversed = axis[0] == '+';
            has_y = true;
        } else {
            return malformed;
        }
    }
    return words.next().empty() ? Status(Done{}) : malformed;
}

}  // namespace

Result<HdrHeader> parse_hdr_header(std::span<const std::byte> bytes, std::string_view name) {
    HdrHeader header;
    Lines lines(bytes, name);

    // Read variables up to the blank line.
    bool has_format = false;
    for (bool first = true;; first = false) {
        const Result<std::string_view> line = lines.next();
        if (!line) return line.error();
        if (first && !line->starts_with("#?")) return lines.error("a Radiance picture begins with \"#?\"");
        if (line->empty()) break;
        has_format = has_format || line->starts_with("FORMAT=");
        if (const Status status = apply_line(header, *line, lines); !status) return status.error();
    }
    if (header.foreign_primaries && header.encoding == HdrHeader::Encoding::rgbe)
        header.warnings.emplace_back("PRIMARIES are not those of Rec. 709; pixels are taken as Rec. 709 unchanged");
    if (!has_format) header.warnings.emplace_back("the header has no FORMAT line; pixels are taken as RGBE");

    // Read the resolution line that follows it.
    const Result<std::string_view> line = lines.next();
    if (!line) return line.error();
    if (const Status status = apply_resolution(header, *line, lines); !status) return status.error();
    header.end = lines.offset();
    return header;
}

}  // namespace lobelia::io
