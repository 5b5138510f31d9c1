// Typed, checked access to the values of a JSON document.
#include "io/json.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace lobelia {

using nlohmann::json;

struct JsonDocument::Content {
    json top;
    std::string file;
    JsonLimits limits;
};

Result<JsonDocument> JsonDocument::parse(std::string_view text, const std::string& file, const JsonLimits& limits) {
    auto top = parse_json(text, file, limits);
    if (!top) return top.error();
    JsonDocument document;
    document.content_ = std::make_shared<const Content>(Content{*std::move(top), file, limits});
    return document;
}

const std::string& JsonDocument::file() const { return content_->file; }

JsonPlace::JsonPlace(const JsonDocument& document) : JsonPlace(document.content_->top, *document.content_) {
    if (!value_->is_object()) throw JsonRefusal(content_->file + ": not a JSON object");
}

namespace {

/// Appends the path from `from` to `target`; false if it is not below. Recursion is as deep as the parser's limit.
bool find_path(const json& from, const json* target, std::string& path) {
    if (&from == target) return true;
    const std::size_t size = path.size();
    if (from.is_array())
        for (std::size_t i = 0; i < from.size(); ++i) {
            path += fmt::format("[{}]", i);
            if (find_path(from[i], target, path)) return true;
            path.resize(size);
        }
    if (from.is_object())
        for (const auto& [key, value] : from.get_ref<const json::object_t&>()) {
            path += fmt::format("{}{:.60}", size == 0 ? "" : ".", key);
            if (find_path(value, target, path)) return true;
            path.resize(size);
        }
    return false;
}

}  // namespace

std::string JsonPlace::path() const {
    std::string path;
    find_path(content_->top, value_, path);
    return path.empty() ? "at the top" : path;
}

void JsonPlace::refuse(std::string_view problem) const {
    throw JsonRefusal(fmt::format("{}: {}: {}", content_->file, path(), problem));
}

std::optional<JsonPlace> JsonPlace::find(const char* key) const {
    if (!value_->is_object()) refuse("not an object");
    const auto found = value_->find(key);
    if (found == value_->end() || found->is_null()) return std::nullopt;
    return JsonPlace(*found, *content_);
}

JsonPlace JsonPlace::at(const char* key) const {
    const auto found = find(key);
    if (!found) refuse(fmt::format("no \"{}\"", key));
    return *found;
}

std::vector<std::pair<std::string_view, JsonPlace>> JsonPlace::members() const {
    if (!value_->is_object()) refuse("not an object");
    std::vector<std::pair<std::string_view, JsonPlace>> members;
    for (const auto& [key, value] : value_->get_ref<const json::object_t&>())
        members.emplace_back(key, JsonPlace(value, *content_));
    return members;
}

std::vector<JsonPlace> JsonPlace::list(std::size_t most) const {
    if (!value_->is_array()) refuse("not an array");
    if (value_->size() > most) refuse(fmt::format("{} entries, more than {}", value_->size(), most));
    std::vector<JsonPlace> entries;
    entries.reserve(value_->size());
    for (const json& entry : *value_) entries.push_back(JsonPlace(entry, *content_));
    return entries;
}

std::vector<JsonPlace> JsonPlace::list_of(std::size_t size) const {
    if (!value_->is_array()) refuse("not an array");
    if (value_->size() != size) refuse(fmt::format("{} entries, not {}", value_->size(), size));
    return list(size);
}

bool JsonPlace::is_object() const { return value_->is_object(); }
bool JsonPlace::is_list() const { return value_->is_array(); }
bool JsonPlace::is_null() const { return value_->is_null(); }
std::size_t JsonPlace::size() const { return value_->is_structured() ? value_->size() : 0; }

std::string_view JsonPlace::long_text() const {
    if (!value_->is_string()) refuse("not a string");
    return value_->get_ref<const std::string&>();
}

std::string JsonPlace::text() const {
    const std::string_view text = long_text();
    const std::size_t most = content_->limits.longest_text;
    if (text.size() > most) refuse(fmt::format("a string of more than {} bytes", most));
    return std::string(text);
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

namespace {

std::optional<std::uint64_t> whole_of(const json& value) {
    if (value.is_number_unsigned()) return value.get<std::uint64_t>();
    // Beyond 2^53, doubles are no longer exact.
    constexpr double k_most_exact = 0x1p53;
    const double number = value.is_number_float() ? value.get<double>() : -1;
    if (!(number >= 0 && number <= k_most_exact) || number != std::floor(number)) return std::nullopt;
    return static_cast<std::uint64_t>(number);
}

}  // namespace

bool JsonPlace::is_whole() const { return whole_of(*value_).has_value(); }

std::uint64_t JsonPlace::whole(std::uint64_t least, std::uint64_t most) const {
    const auto whole = whole_of(*value_);
    if (!whole || *whole < least || *whole > most) refuse(fmt::format("not a whole number from {} to {}", least, most));
    return *whole;
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

void JsonPlace::numbers(std::span<double> target) const {
    if (!value_->is_array() || value_->size() != target.size()) refuse(fmt::format("not {} numbers", target.size()));
    for (std::size_t i = 0; i < target.size(); ++i) target[i] = JsonPlace((*value_)[i], *content_).number();
}

void JsonPlace::expect(const json& expected) const {
    if (expected.is_object()) {
        for (const auto& [key, value] : expected.items()) at(key.c_str()).expect(value);
    } else if (expected.is_array()) {
        const auto entries = list_of(expected.size());
        for (std::size_t i = 0; i < entries.size(); ++i) entries[i].expect(expected[i]);
    } else if (*value_ != expected) {
        refuse("not " + json_text(expected));
    }
}

std::size_t JsonPlace::one_of(const std::vector<std::string>& names) const {
    const std::string name = text();
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) refuse(fmt::format("\"{}\" is none of {}", name, fmt::join(names, ", ")));
    return static_cast<std::size_t>(found - names.begin());
}

double shortest(float value) {
    std::array<char, 32> text{};
    const auto written = std::to_chars(text.data(), text.data() + text.size(), value);
    double result = 0;
    std::from_chars(text.data(), written.ptr, result);
    return result;
}

}  // namespace lobelia
