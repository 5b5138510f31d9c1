// The one JSON reader (RFC 8259): strict, safe on untrusted bytes; errors name the file and the place in it.
//
//   Result<Options> options_from(std::string_view text, const std::string& file) {
//       return read_json(text, file, [](const JsonPlace& top) {
//           return Options{.samples = top.at("samples").whole(1, 1000), .name = top.at("name").text()};
//       });
//   }
#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "lobelia/math.h"
#include "lobelia/result.h"

namespace lobelia {

/// Limits that are checked before memory or stack is used.
struct JsonLimits {
    std::size_t most_depth = 64;                      ///< nested arrays and objects
    std::size_t most_values = std::size_t{1} << 27;   ///< numbers, strings, arrays, objects and so on
    std::size_t longest_text = std::size_t{1} << 20;  ///< bytes of a string that JsonPlace::text() returns
    const std::atomic<bool>* stop = nullptr;          ///< ends the parsing with an error when it becomes true
};

/// Parses `text`; messages call it `file`. Besides what is not JSON, the error is: nesting deeper than the limit, a key
/// that an object holds twice, a number beyond double precision. The message gives byte, line and column.
[[nodiscard]] Result<nlohmann::json> parse_json(std::string_view text, const std::string& file,
                                                const JsonLimits& limits = {});

/// Why content was refused: file, place, problem. Thrown by JsonPlace, caught by read_json.
struct JsonRefusal : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A parsed document. Copies share the content.
class JsonDocument {
  public:
    [[nodiscard]] static Result<JsonDocument> parse(std::string_view text, const std::string& file,
                                                    const JsonLimits& limits = {});
    [[nodiscard]] const std::string& file() const;

  private:
    friend class JsonPlace;
    struct Content;
    std::shared_ptr<const Content> content_;
};

/// A value of a document, which must outlive it. Every getter throws JsonRefusal if the value is of another type or out
/// of range. Small and cheap to copy: the place is looked up when a message needs it.
class JsonPlace {
  public:
    /// The outermost value, which must be an object.
    explicit JsonPlace(const JsonDocument& document);

    /// The path of keys and indices, such as "meshes[3].name"; "at the top" for the outermost value.
    [[nodiscard]] std::string path() const;
    [[noreturn]] void refuse(std::string_view problem) const;

    /// A member of an object, which must exist.
    [[nodiscard]] JsonPlace at(const char* key) const;
    /// A member that may be missing or null.
    [[nodiscard]] std::optional<JsonPlace> find(const char* key) const;
    [[nodiscard]] bool has(const char* key) const { return find(key).has_value(); }
    /// All members of an object, by key.
    [[nodiscard]] std::vector<std::pair<std::string_view, JsonPlace>> members() const;
    /// The entries of an array of at most `most`, or of exactly `size`.
    [[nodiscard]] std::vector<JsonPlace> list(std::size_t most) const;
    [[nodiscard]] std::vector<JsonPlace> list_of(std::size_t size) const;

    [[nodiscard]] bool is_object() const;
    [[nodiscard]] bool is_list() const;
    [[nodiscard]] bool is_null() const;
    /// Entries of an array or members of an object; 0 for other values.
    [[nodiscard]] std::size_t size() const;

    [[nodiscard]] std::string text() const;
    /// A view of a string of any length.
    [[nodiscard]] std::string_view long_text() const;
    /// A string that is a file name and not a path: no separators, neither "." nor "..", no control characters.
    [[nodiscard]] std::string file_name() const;
    [[nodiscard]] bool flag() const;
    /// A whole number in [least, most]. Numbers written as floats (2.0, 2e3) are accepted if they are whole.
    [[nodiscard]] std::uint64_t whole(std::uint64_t least, std::uint64_t most) const;
    [[nodiscard]] bool is_whole() const;
    /// Finite; in [least, most]; in float's range.
    [[nodiscard]] double number() const;
    [[nodiscard]] double number_in(double least, double most) const;
    [[nodiscard]] float single() const;
    [[nodiscard]] Vec3 vector() const;
    /// Reads as many numbers as `target` has elements.
    void numbers(std::span<double> target) const;
    /// Refuses a value that differs from `expected`; objects may have further members.
    void expect(const nlohmann::json& expected) const;
    /// The index of the string in `names`.
    template <std::size_t N>
    [[nodiscard]] std::size_t one_of(const std::array<const char*, N>& names) const {
        return one_of(std::vector<std::string>(names.begin(), names.end()));
    }
    [[nodiscard]] std::size_t one_of(const std::vector<std::string>& names) const;

  private:
    JsonPlace(const nlohmann::json& value, const JsonDocument::Content& content) : value_(&value), content_(&content) {}

    const nlohmann::json* value_;
    const JsonDocument::Content* content_;
};

/// Parses `text` and calls `read` with its outermost value; refusals become errors.
template <class Read>
[[nodiscard]] auto read_json(std::string_view text, const std::string& file, const Read& read,
                             const JsonLimits& limits = {}) -> Result<std::invoke_result_t<Read, JsonPlace>> {
    const auto document = JsonDocument::parse(text, file, limits);
    if (!document) return document.error();
    try {
        return read(JsonPlace(*document));
    } catch (const JsonRefusal& refusal) {
        return Error{refusal.what()};
    }
}

/// The text of a JSON value, on one line unless `indent` is 0 or more. Bytes of its strings that are not UTF-8 become
/// U+FFFD. Requires <nlohmann/json.hpp>.
template <class Json>
[[nodiscard]] std::string json_text(const Json& value, int indent = -1) {
    return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

/// The path of the first number in a value that JSON cannot hold, NaN or an infinity, such as "methods/3/error"; none
/// if all are finite. nlohmann writes null in its place.
template <class Json>
[[nodiscard]] std::optional<std::string> first_not_finite(const Json& value) {
    if (value.is_number_float()) {
        const double number = value;
        return std::isfinite(number) ? std::nullopt : std::optional<std::string>("");
    }
    if (!value.is_structured()) return std::nullopt;
    for (const auto& [key, entry] : value.items())
        if (const auto within = first_not_finite(entry)) return key + (within->empty() ? "" : "/" + *within);
    return std::nullopt;
}

/// The text of a report's figures. An error if one of them is not finite.
template <class Json>
[[nodiscard]] Result<std::string> figures_text(const Json& figures) {
    if (const auto place = first_not_finite(figures))
        return Error{"the figure \"" + *place + "\" is not finite: is the light too bright for float32?"};
    return json_text(figures, 1) + "\n";
}

/// A float as the double with the shortest decimal text that reads back as the float.
[[nodiscard]] double shortest(float value);

}  // namespace lobelia
