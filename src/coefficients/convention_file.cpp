// Writes and reads coefficients in the files of others.
#include "coefficients/convention_file.h"

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/math/harmonics.h"
#include "io/json.h"

namespace lobelia {
namespace {

using nlohmann::json;
using Form = ShConvention::Form;

constexpr std::array<const char*, 3> k_channels = {"r", "g", "b"};

float channel(Rgb c, std::size_t k) { return k == 0 ? c.r : k == 1 ? c.g : c.b; }

json channels(std::span<const Rgb> c, std::size_t k) {
    json list = json::array();
    for (const Rgb& value : c) list.push_back(channel(value, k));
    return list;
}

json unity_json(std::span<const Rgb> nine) {
    const UnityShaderConstants constants = unity_constants(nine);
    return {{"SphericalHarmonicsL2", {channels(nine, 0), channels(nine, 1), channels(nine, 2)}},
            {"SHAr", constants.A[0]},
            {"SHAg", constants.A[1]},
            {"SHAb", constants.A[2]},
            {"SHBr", constants.B[0]},
            {"SHBg", constants.B[1]},
            {"SHBb", constants.B[2]},
            {"SHC", constants.C}};
}

/// Reads numbers from JSON and keeps the first error.
class Reader {
  public:
    Reader(const ShConvention& convention, std::string name) : convention_(convention), name_(std::move(name)) {}

    [[nodiscard]] Result<std::vector<Rgb>> read(const json& file) {
        if (!file.is_object()) return Error{name_ + ": not a JSON object"};
        if (const json& named = member(file, "convention");
            named.is_string() && named.get<std::string>() != convention_.name)
            return Error{name_ + ": is of convention " + json_text(named) + ", not \"" + std::string(convention_.name) +
                         "\""};
        std::vector<Rgb> c;
        switch (convention_.form) {
            case Form::rows:
                c = rows(file);
                break;
            case Form::flat:
                c = flat(file);
                break;
            case Form::channels:
                c = columns(file, k_channels);
                break;
            case Form::unity:
                c = unity(file);
                break;
        }
        if (!error_.empty()) return Error{name_ + ": " + error_};
        return c;
    }

  private:
    static const json& member(const json& object, const char* key) {
        static const json none;
        return object.is_object() && object.contains(key) ? object[key] : none;
    }

    void fail(std::string what) {
        if (error_.empty()) error_ = std::move(what);
    }

    float number(const json& value, const std::string& what) {
        const double v = value.is_number() ? value.get<double>() : NAN;
        const auto narrow = static_cast<float>(v);
        if (!std::isfinite(narrow)) fail(what + " is not a finite number");
        return std::isfinite(narrow) ? narrow : 0;
    }

    /// An array of numbers.
    std::vector<float> numbers(const json& list, const std::string& what) {
        if (!list.is_array()) fail("no array \"" + what + "\" in it");
        std::vector<float> result;
        for (std::size_t i = 0; list.is_array() && i < list.size(); ++i)
            result.push_back(number(list[i], what + "[" + std::to_string(i) + "]"));
        return result;
    }

    void expect_count(std::size_t found) {
        const std::size_t most = harmonics::coefficient_count(convention_.degree);
        if (convention_.degrees == ShConvention::Degrees::exactly) {
            if (found != most)
                fail(std::to_string(most) + " coefficients expected, but it holds " + std::to_string(found));
            return;
        }
        for (std::size_t l = 0; l <= convention_.degree; ++l)
            if (found == harmonics::coefficient_count(l)) return;
        fail(std::to_string(found) + " coefficients, which no degree up to " + std::to_string(convention_.degree) +
             " has");
    }

    std::vector<Rgb> rows(const json& file) {
        float intensity = 1;
        const json& list = list_of(file, intensity);
        const std::string key(convention_.key);
        if (!list.is_array()) fail("no array \"" + key + "\" in it");
        expect_count(list.is_array() ? list.size() : 0);
        std::vector<Rgb> c;
        for (std::size_t i = 0; error_.empty() && i < list.size(); ++i) {
            const auto row = numbers(list[i], key + "[" + std::to_string(i) + "]");
            if (row.size() != 3) fail("coefficient " + std::to_string(i) + " is not three numbers");
            if (error_.empty()) c.push_back(Rgb{row[0], row[1], row[2]} * intensity);
        }
        return c;
    }

    /// The array by its key, or that of the first light of a glTF file.
    const json& list_of(const json& file, float& intensity) {
        const std::string key(convention_.key);
        const json& lights = member(member(member(file, "extensions"), "EXT_lights_image_based"), "lights");
        if (member(file, key.c_str()).is_array() || !lights.is_array() || lights.empty())
            return member(file, key.c_str());
        if (lights[0].is_object() && lights[0].contains("intensity"))
            intensity = number(lights[0]["intensity"], "intensity");
        return member(lights[0], key.c_str());
    }

    std::vector<Rgb> flat(const json& file) {
        const std::string key(convention_.key);
        // A light's own JSON has them one level down.
        const json& list = member(file, key.c_str()).is_array() ? member(file, key.c_str())
                                                                : member(member(file, "object"), key.c_str());
        const auto all = numbers(list, key);
        if (all.size() % 3 != 0) fail("\"" + key + "\" is not three numbers for each coefficient");
        expect_count(all.size() / 3);
        std::vector<Rgb> c;
        for (std::size_t i = 0; i + 2 < all.size(); i += 3) c.push_back({all[i], all[i + 1], all[i + 2]});
        return c;
    }

    template <class Key>
    std::vector<Rgb> columns(const json& object, const std::array<Key, 3>& keys) {
        std::array<std::vector<float>, 3> lists;
        for (std::size_t k = 0; k < 3; ++k) {
            if constexpr (std::is_same_v<Key, const char*>)
                lists[k] = numbers(member(object, keys[k]), keys[k]);
            else
                lists[k] = numbers(object[keys[k]], std::string(convention_.key) + "[" + std::to_string(k) + "]");
        }
        expect_count(lists[0].size());
        if (lists[1].size() != lists[0].size() || lists[2].size() != lists[0].size())
            fail("the channels have not the same number of coefficients");
        std::vector<Rgb> c;
        for (std::size_t i = 0; error_.empty() && i < lists[0].size(); ++i)
            c.push_back({lists[0][i], lists[1][i], lists[2][i]});
        return c;
    }

    std::vector<Rgb> unity(const json& file) {
        if (const json& matrix = member(file, "SphericalHarmonicsL2"); !matrix.is_null()) {
            if (!matrix.is_array() || matrix.size() != 3) {
                fail("SphericalHarmonicsL2 is not three arrays of nine numbers");
                return {};
            }
            return columns(matrix, std::array<std::size_t, 3>{0, 1, 2});
        }
        UnityShaderConstants constants;
        const auto vector = [&](const char* key, std::array<float, 4>& out) {
            const auto list = numbers(member(file, key), key);
            if (list.size() != 4) fail(std::string(key) + " is not four numbers");
            if (list.size() == 4) std::copy_n(list.begin(), 4, out.begin());
        };
        for (const auto& [key, out] : {std::pair{"SHAr", &constants.A[0]},
                                       {"SHAg", &constants.A[1]},
                                       {"SHAb", &constants.A[2]},
                                       {"SHBr", &constants.B[0]},
                                       {"SHBg", &constants.B[1]},
                                       {"SHBb", &constants.B[2]},
                                       {"SHC", &constants.C}})
            vector(key, *out);
        return coefficients_of(constants);
    }

    const ShConvention& convention_;
    std::string name_, error_;
};

/// cmgen's text: a line "( r, g, b); // comment" for each coefficient.
Result<std::vector<Rgb>> rows_of_text(const ShConvention& convention, std::string_view text, const std::string& name) {
    std::vector<Rgb> c;
    for (std::size_t line = 1; !text.empty(); ++line) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        std::string_view row = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        const auto bad = [&] { return Error{name + ":" + std::to_string(line) + ": expected \"(r, g, b);\""}; };
        const auto skip = [&](std::string_view characters) {
            row.remove_prefix(std::min(row.find_first_not_of(characters), row.size()));
        };
        skip(" \t\r");
        if (row.empty() || row.starts_with("//")) continue;
        if (row.front() != '(') return bad();
        float rgb[3] = {};
        for (std::size_t k = 0; k < 3; ++k) {
            skip(k == 0 ? "( \t" : ", \t");
            const auto [rest, error] = std::from_chars(row.data(), row.data() + row.size(), rgb[k]);
            if (error != std::errc() || !std::isfinite(rgb[k])) return bad();
            row.remove_prefix(static_cast<std::size_t>(rest - row.data()));
        }
        skip(" \t");
        if (!row.starts_with(")")) return bad();
        c.push_back({rgb[0], rgb[1], rgb[2]});
    }
    const std::size_t expected = harmonics::coefficient_count(convention.degree);
    if (c.size() != expected)
        return Error{name + ": " + std::to_string(expected) + " coefficients expected, but it holds " +
                     std::to_string(c.size())};
    return c;
}

}  // namespace

json to_json(const ShConvention& convention, std::span<const Rgb> theirs) {
    json file;
    const std::string key(convention.key);
    switch (convention.form) {
        case Form::rows:
            file[key] = json::array();
            for (const Rgb& c : theirs) file[key].push_back({c.r, c.g, c.b});
            break;
        case Form::flat:
            file[key] = json::array();
            for (const Rgb& c : theirs)
                for (std::size_t k = 0; k < 3; ++k) file[key].push_back(channel(c, k));
            break;
        case Form::channels:
            for (std::size_t k = 0; k < 3; ++k) file[k_channels[k]] = channels(theirs, k);
            break;
        case Form::unity:
            file = unity_json(theirs);
            break;
    }
    file["convention"] = convention.name;
    return file;
}

Result<std::vector<Rgb>> convention_from_text(const ShConvention& convention, std::string_view text,
                                              const std::string& name) {
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    const bool is_rows = first != std::string_view::npos && (text[first] == '(' || text.substr(first, 2) == "//");
    if (convention.form == Form::rows && is_rows) return rows_of_text(convention, text, name);
    const auto file = parse_json(text, name);
    if (!file) return file.error();
    return Reader(convention, name).read(*file);
}

}  // namespace lobelia
