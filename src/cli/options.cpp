// Checks of options.
#include "cli/options.h"

#include <fmt/core.h>

#include <charconv>

namespace lobelia::cli {

CLI::Validator number_in(double low, double high) {
    const auto check = [low, high](const std::string& text) {
        double value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool good = error == std::errc() && end == text.data() + text.size() && value >= low && value <= high;
        return good ? std::string() : fmt::format("{} is not a number from {} to {}", text, low, high);
    };
    return CLI::Validator(check, fmt::format("FLOAT in [{} - {}]", low, high));
}

}  // namespace lobelia::cli
