// Strict reading of JSON that anybody may have written.
#include "bake/write/json_place.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace lobelia {

namespace {

constexpr std::size_t k_longest_text = std::size_t{1} << 20;

}  // namespace

void JsonPlace::refuse(std::string_view problem) const {
    throw JsonRefusal(fmt::format("{}: {}: {}", *file_, place_.empty() ? "at the top" : place_, problem));
}

std::optional<JsonPlace> JsonPlace::find(const char* key) const {
    if (!value_->is_object()) refuse("not an object");
    const auto found = value_->find(key);
    if (found == value_->end() || found->is_null()) return std::nullopt;
    return JsonPlace(*found, file_, place_.empty() ? std::string(key) : place_ + "." + key);
}

JsonPlace JsonPlace::at(const char* key) const {
    const auto found = find(key);
    if (!found) refuse(fmt::format("no \"{}\"", key));
    return *found;
}

std::vector<JsonPlace> JsonPlace::list(std::size_t most) const {
    if (!value_->is_array()) refuse("not a list");
    if (value_->size() > most) refuse(fmt::format("{} entries, more than {}", value_->size(), most));
    std::vector<JsonPlace> entries;
    entries.reserve(value_->size());
    for (std::size_t i = 0; i < value_->size(); ++i)
        entries.push_back(JsonPlace((*value_)[i], file_, fmt::format("{}[{}]", place_, i)));
    return entries;
}

std::vector<JsonPlace> JsonPlace::list_of(std::size_t size) const {
    if (!value_->is_array()) refuse("not a list");
    if (value_->size() != size) refuse(fmt::format("{} entries, not {}", value_->size(), size));
    return list(size);
}

std::string JsonPlace::text() const {
    if (!value_->is_string()) refuse("not a text");
    const auto& text = value_->get_ref<const std::string&>();
    if (text.size() > k_longest_text) refuse(fmt::format("a text of more than {} bytes", k_longest_text));
    return text;
}

std::string JsonPlace::file_name() const {
    std::string name = text();
    const auto is_bad = [](unsigned char c) { return c < 32 || c == 127 || c == '/' || c == '\\' || c == ':'; };
    if (name.empty() || name == "." || name == ".." || std::any_of(name.begin(), name.end(), is_bad))
        refuse("not the name of a file of this folder");
    return name;
}

bool JsonPlace::flag() const {
    if (!value_->is_boolean()) refuse("neither true nor false");
    return value_->get<bool>();
}

std::uint64_t JsonPlace::whole(std::uint64_t least, std::uint64_t most) const {
    const bool fits =
        value_->is_number_unsigned() && value_->get<std::uint64_t>() >= least && value_->get<std::uint64_t>() <= most;
    if (!fits) refuse(fmt::format("not a whole number from {} to {}", least, most));
    return value_->get<std::uint64_t>();
}

double JsonPlace::number() const {
    const double value = value_->is_number() ? value_->get<double>() : std::numeric_limits<double>::quiet_NaN();
    if (!std::isfinite(value)) refuse("not a finite number");
    return value;
}

double JsonPlace::number_in(double least, double most) const {
    const double value = number();
    if (value < least || value > most) refuse(fmt::format("{} is not in [{}, {}]", value, least, most));
    return value;
}

float JsonPlace::single() const {
    constexpr double k_most = std::numeric_limits<float>::max();
    return static_cast<float>(number_in(-k_most, k_most));
}

Vec3 JsonPlace::vector() const {
    const auto entries = list_of(3);
    return {entries[0].single(), entries[1].single(), entries[2].single()};
}

void JsonPlace::expect(const nlohmann::json& expected) const {
    if (expected.is_object()) {
        for (const auto& [key, value] : expected.items()) at(key.c_str()).expect(value);
    } else if (expected.is_array()) {
        const auto entries = list_of(expected.size());
        for (std::size_t i = 0; i < entries.size(); ++i) entries[i].expect(expected[i]);
    } else if (*value_ != expected) {
        refuse("not " + expected.dump());
    }
}

std::size_t JsonPlace::one_of(const std::vector<std::string>& names) const {
    const std::string name = text();
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) refuse(fmt::format("\"{}\" is none of {}", name, fmt::join(names, ", ")));
    return static_cast<std::size_t>(found - names.begin());
}

nlohmann::json parse_json(std::string_view text, const std::string& file) {
    try {
        nlohmann::json document = nlohmann::json::parse(text);
        if (!document.is_object()) throw JsonRefusal(file + ": not a JSON object");
        return document;
    } catch (const nlohmann::json::parse_error& error) {
        throw JsonRefusal(fmt::format("{}: not JSON near byte {} of {}", file, error.byte, text.size()));
    } catch (const nlohmann::json::out_of_range&) {
        throw JsonRefusal(file + ": a number that is beyond double precision");
    }
}

double shortest(float value) {
    std::array<char, 32> text{};
    const auto written = std::to_chars(text.data(), text.data() + text.size(), value);
    double result = 0;
    std::from_chars(text.data(), written.ptr, result);
    return result;
}

}  // namespace lobelia
