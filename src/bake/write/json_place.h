// Strict reading of JSON that anybody may have written: each value knows its place, and what does not fit is refused
// with it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "lobelia/math.h"

namespace lobelia {

/// A fault of the file: its name, the place and the problem. It never leaves the reader of the file.
struct JsonRefusal : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A value of a document, which outlives it.
class JsonPlace {
  public:
    JsonPlace(const nlohmann::json& value, const std::string& file)
        : JsonPlace(value, std::make_shared<const std::string>(file), {}) {}

    [[noreturn]] void refuse(std::string_view problem) const;

    /// A member of an object, which must be there; or which may be missing or null.
    [[nodiscard]] JsonPlace at(const char* key) const;
    [[nodiscard]] std::optional<JsonPlace> find(const char* key) const;
    /// The entries of a list of at most `most`, or of exactly `size`.
    [[nodiscard]] std::vector<JsonPlace> list(std::size_t most) const;
    [[nodiscard]] std::vector<JsonPlace> list_of(std::size_t size) const;

    [[nodiscard]] std::string text() const;
    /// Not empty, and no path: no separators, neither "." nor "..", no control characters.
    [[nodiscard]] std::string file_name() const;
    [[nodiscard]] bool flag() const;
    [[nodiscard]] std::uint64_t whole(std::uint64_t least, std::uint64_t most) const;
    /// Finite, in float's range where that is asked for.
    [[nodiscard]] double number() const;
    [[nodiscard]] double number_in(double least, double most) const;
    [[nodiscard]] float single() const;
    [[nodiscard]] Vec3 vector() const;
    /// Refuses what is not as `expected`; objects may have members besides.
    void expect(const nlohmann::json& expected) const;
    /// One of the names, as its index.
    template <std::size_t N>
    [[nodiscard]] std::size_t one_of(const std::array<const char*, N>& names) const {
        return one_of(std::vector<std::string>(names.begin(), names.end()));
    }
    [[nodiscard]] std::size_t one_of(const std::vector<std::string>& names) const;

  private:
    JsonPlace(const nlohmann::json& value, std::shared_ptr<const std::string> file, std::string place)
        : value_(&value), file_(std::move(file)), place_(std::move(place)) {}

    const nlohmann::json* value_;
    std::shared_ptr<const std::string> file_;
    std::string place_;
};

/// The document, or a refusal.
[[nodiscard]] nlohmann::json parse_json(std::string_view text, const std::string& file);

/// A float as the shortest number that reads back as it.
[[nodiscard]] double shortest(float value);

}  // namespace lobelia
