// Parses JSON text, and reports the place and cause of errors.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/stop.h"
#include "io/json.h"

namespace lobelia {
namespace {

using nlohmann::json;

/// The parser's own text without its error codes in front and its name for the place.
std::string reason(std::string message) {
    const auto place = message.find(": syntax error"), code_end = message.find("] ");
    if (place != std::string::npos)
        message.erase(0, place + 2);
    else if (message.starts_with('[') && code_end != std::string::npos)
        message.erase(0, code_end + 2);
    // The last token may hold any bytes: keep the line short and printable.
    constexpr std::size_t most = 160;
    for (char& c : message)
        if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f) c = '?';
    if (message.size() > most) message.replace(most, std::string::npos, "...");
    return message;
}

/// Tests if the word around this position is a common spelling of NaN or infinity.
bool is_nan_or_infinity(std::string_view text, std::size_t position) {
    constexpr std::string_view letters = "+-abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
    const std::size_t before = text.substr(0, position).find_last_not_of(letters);
    const std::size_t begin = before == std::string_view::npos ? 0 : before + 1;
    const std::size_t size = std::min<std::size_t>(text.substr(begin).find_first_not_of(letters), 16);
    std::string word(text.substr(begin, size));
    std::transform(word.begin(), word.end(), word.begin(), [](char c) { return static_cast<char>(c | 0x20); });
    return word.ends_with("nan") || word.ends_with("inf") || word.ends_with("infinity");
}

/// Builds the document from the parser's events; each handler returns false to stop it.
class Builder {
  public:
    explicit Builder(const JsonLimits& limits) : limits_(limits) {}

    bool null() { return add(nullptr); }
    bool boolean(bool value) { return add(value); }
    bool number_integer(json::number_integer_t value) { return add(value); }
    bool number_unsigned(json::number_unsigned_t value) { return add(value); }
    bool number_float(json::number_float_t value, const std::string& /*text*/) { return add(value); }
    bool string(std::string& value) { return add(std::move(value)); }
    bool binary(json::binary_t& /*value*/) { return stop("binary data"); }
    bool start_object(std::size_t /*size*/) { return open(json::object()); }
    bool start_array(std::size_t /*size*/) { return open(json::array()); }
    bool end_object() { return close(); }
    bool end_array() { return close(); }
    bool key(std::string& name) {
        const auto [entry, is_new] = stack_.back()->get_ref<json::object_t&>().emplace(name, nullptr);
        member_ = &entry->second;
        return is_new || stop(fmt::format("duplicate key \"{:.60}\" in an object", name));
    }
    bool parse_error(std::size_t byte, const std::string& /*token*/, const json::exception& error) {
        byte_ = byte;
        const bool overflow = dynamic_cast<const json::out_of_range*>(&error) != nullptr;
        return stop(overflow ? "a number beyond double precision" : reason(error.what()));
    }

    [[nodiscard]] json take() { return std::move(root_); }
    [[nodiscard]] const std::string& problem() const { return problem_; }
    /// Returns the byte at which the parser failed, counted from 1; nothing if a handler failed.
    [[nodiscard]] std::optional<std::size_t> byte() const { return byte_; }

  private:
    bool stop(std::string problem) {
        problem_ = std::move(problem);
        return false;
    }
    /// Puts a value where the document stands: at the top, at the end of an array, or at the last key.
    bool add(json value) {
        if (++values_ > limits_.most_values) return stop(fmt::format("more than {} values", limits_.most_values));
        if (StopFlag(limits_.stop).is_set()) return stop("stopped");
        if (stack_.empty()) {
            root_ = std::move(value);
            last_ = &root_;
        } else if (stack_.back()->is_array()) {
            last_ = &stack_.back()->get_ref<json::array_t&>().emplace_back(std::move(value));
        } else {
            *member_ = std::move(value);
            last_ = member_;
        }
        return true;
    }
    bool open(json value) {
        if (stack_.size() >= limits_.most_depth)
            return stop(fmt::format("the JSON nests more than {} levels deep", limits_.most_depth));
        if (!add(std::move(value))) return false;
        stack_.push_back(last_);
        return true;
    }
    bool close() {
        stack_.pop_back();
        return true;
    }

    const JsonLimits& limits_;
    json root_;
    std::vector<json*> stack_;  ///< open arrays and objects; stable, for only the innermost grows
    json* last_ = nullptr;
    json* member_ = nullptr;
    std::size_t values_ = 0;
    std::string problem_;
    std::optional<std::size_t> byte_;
};

}  // namespace

Result<nlohmann::json> parse_json(std::string_view text, const std::string& file, const JsonLimits& limits) {
    Builder builder(limits);
    if (json::sax_parse(text, &builder)) return builder.take();
    if (!builder.byte()) return Error{fmt::format("{}: invalid JSON: {}", file, builder.problem())};

    // Find the line and column of the byte.
    const std::size_t byte = std::min<std::size_t>(*builder.byte(), text.size());
    const std::string_view before = text.substr(0, byte > 0 ? byte - 1 : 0);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::size_t line_end = before.rfind('\n');
    const std::size_t column = before.size() - (line_end == std::string_view::npos ? 0 : line_end + 1) + 1;
    return Error{fmt::format(
        "{}: invalid JSON at byte {} (line {}, column {}): {}", file, *builder.byte(), line, column,
        is_nan_or_infinity(text, before.size()) ? "NaN and Infinity are not valid JSON" : builder.problem())};
}

}  // namespace lobelia
