// Parses JSON, and says where it is broken.
#include "io/json.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace lobelia {
namespace {

/// The reason out of the library's message, which has its own error codes before and its name for the place after.
std::string reason(std::string message) {
    const auto place = message.find(": syntax error"), code_end = message.find("] ");
    if (place != std::string::npos)
        message.erase(0, place + 2);
    else if (message.starts_with('[') && code_end != std::string::npos)
        message.erase(0, code_end + 2);
    // Whatever was read last may be anything: keep the line short and printable.
    constexpr std::size_t most = 160;
    for (char& c : message)
        if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f) c = '?';
    return message.size() <= most ? message : message.substr(0, most) + "...";
}

/// Whether the word around this place is how others write what is no number: NaN, -inf, Infinity.
bool is_no_number(std::string_view text, std::size_t place) {
    constexpr std::string_view letters = "+-abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
    const std::size_t before = text.substr(0, place).find_last_not_of(letters);
    const std::size_t begin = before == std::string_view::npos ? 0 : before + 1;
    std::string word(text.substr(begin, text.substr(begin).find_first_not_of(letters)));
    std::transform(word.begin(), word.end(), word.begin(), [](char c) { return static_cast<char>(c | 0x20); });
    return word.ends_with("nan") || word.ends_with("inf") || word.ends_with("infinity");
}

}  // namespace

Result<nlohmann::json> checked_json(std::string_view text, const std::string& name) {
    try {
        return nlohmann::json::parse(text);
    } catch (const nlohmann::json::parse_error& error) {
        const std::size_t byte = std::min<std::size_t>(error.byte, text.size());
        const std::string_view before = text.substr(0, byte > 0 ? byte - 1 : 0);
        const auto line = 1 + std::count(before.begin(), before.end(), '\n');
        const std::size_t line_begin = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
        return Error{name + ": broken JSON at byte " + std::to_string(error.byte) + " (line " + std::to_string(line) +
                     ", column " + std::to_string(before.size() - line_begin + 1) + "): " +
                     (is_no_number(text, before.size()) ? "NaN and infinity are no numbers" : reason(error.what()))};
    } catch (const nlohmann::json::exception& error) {
        // A number that no double can hold.
        return Error{name + ": broken JSON: " + reason(error.what())};
    }
}

}  // namespace lobelia
