// Structs as JSON objects in both directions from one list of their fields:
//
//   void fields(auto& archive, Options& options) {
//       archive.whole("samples", options.samples, 1, 1000);
//   }
//
// With a JsonFieldWriter it fills an object, with a JsonFieldReader it reads one; what is missing keeps its value, and
// members that no field has are ignored or refused.
#pragma once

#include <algorithm>
#include <nlohmann/json.hpp>

#include "io/json.h"

namespace lobelia {

class JsonFieldWriter {
  public:
    template <class T>
    void whole(const char* name, const T& value, std::uint64_t /*least*/, std::uint64_t /*most*/) {
        object[name] = value;
    }
    template <class T>
    void whole(const char* name, const std::optional<T>& value, std::uint64_t /*least*/, std::uint64_t /*most*/) {
        object[name] = value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
    }
    void number(const char* name, const double& value) { object[name] = value; }
    void number(const char* name, const std::optional<double>& value) {
        object[name] = value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
    }
    void text(const char* name, const std::string& value) { object[name] = value; }
    void text(const char* name, const std::optional<std::string>& value) {
        object[name] = value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
    }
    void texts(const char* name, const std::optional<std::vector<std::string>>& value) {
        object[name] = value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
    }
    void flag(const char* name, const bool& value) { object[name] = value; }
    template <class Enum, std::size_t N>
    void choice(const char* name, const Enum& value, const std::array<const char*, N>& names) {
        object[name] = names[static_cast<std::size_t>(value)];
    }
    template <class T>
    void group(const char* name, T& value) {
        JsonFieldWriter inner;
        fields(inner, value);
        object[name] = std::move(inner.object);
    }
    /// Absent groups are null.
    template <class T>
    void group(const char* name, std::optional<T>& value) {
        object[name] = nullptr;
        if (value) group(name, *value);
    }

    nlohmann::ordered_json object = nlohmann::ordered_json::object();
};

class JsonFieldReader {
  public:
    enum class Unknown { ignored, refused };
    explicit JsonFieldReader(JsonPlace place, Unknown unknown = Unknown::ignored) : place_(place), unknown_(unknown) {}

    template <class T>
    void whole(const char* name, T& value, std::uint64_t least, std::uint64_t most) {
        if (const auto found = find(name)) value = static_cast<T>(found->whole(least, most));
    }
    void number(const char* name, double& value) {
        if (const auto found = find(name)) value = found->number();
    }
    void number(const char* name, std::optional<double>& value) {
        if (const auto found = find(name)) value = found->number();
    }
    template <class Text>
    void text(const char* name, Text& value) {
        if (const auto found = find(name)) value = found->text();
    }
    void texts(const char* name, std::optional<std::vector<std::string>>& value) {
        const auto found = find(name);
        if (!found) return;
        constexpr std::size_t k_most_texts = 1024;
        value.emplace();
        for (const auto& text : found->list(k_most_texts)) value->push_back(text.text());
    }
    void flag(const char* name, bool& value) {
        if (const auto found = find(name)) value = found->flag();
    }
    template <class Enum, std::size_t N>
    void choice(const char* name, Enum& value, const std::array<const char*, N>& names) {
        if (const auto found = find(name)) value = static_cast<Enum>(found->one_of(names));
    }
    template <class T>
    void group(const char* name, T& value) {
        if (const auto found = find(name)) {
            JsonFieldReader inner(*found, unknown_);
            fields(inner, value);
            inner.finish();
        }
    }
    template <class T>
    void group(const char* name, std::optional<T>& value) {
        if (place_.find(name)) {
            group(name, value.emplace());
        } else {
            known_.emplace_back(name);
        }
    }
    /// Call it after the last field of the outermost object: refuses unknown members, if they are to be refused.
    void finish() const {
        if (unknown_ == Unknown::ignored) return;
        for (const auto& [name, member] : place_.members())
            if (std::find(known_.begin(), known_.end(), name) == known_.end())
                member.refuse("unknown; is it spelt wrongly, or from a newer version?");
    }

  private:
    std::optional<JsonPlace> find(const char* name) {
        known_.emplace_back(name);
        return place_.find(name);
    }

    JsonPlace place_;
    Unknown unknown_;
    std::vector<std::string_view> known_;
};

}  // namespace lobelia
