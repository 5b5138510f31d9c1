#include "cli/numbers.h"

#include <charconv>
#include <cmath>

namespace lobelia::cli {

std::optional<std::vector<float>> parse_numbers(const std::string& text) {
    std::vector<float> numbers;
    const char *at = text.data(), *end = at + text.size();
    for (;;) {
        float value = 0;
        const auto [rest, code] = std::from_chars(at, end, value);
        if (code != std::errc() || !std::isfinite(value)) return std::nullopt;
        numbers.push_back(value);
        if (rest == end) return numbers;
        if (*rest != ',') return std::nullopt;
        at = rest + 1;
    }
}

}  // namespace lobelia::cli
