// Shared by tests of reports: decodes pictures, and checks what every report must satisfy.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "report/picture.h"

namespace lobelia::test {

/// Returns the value of IEEE 754 binary16 `bits`, from its definition.
inline double value_of_half(std::uint16_t bits) {
    const double sign = bits & 0x8000 ? -1 : 1;
    const int exponent = bits >> 10 & 31, mantissa = bits & 1023;
    if (exponent == 31) return mantissa != 0 ? std::numeric_limits<double>::quiet_NaN() : sign * HUGE_VAL;
    return sign * (exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(1024 + mantissa, exponent - 25));
}

/// Decodes base64 without padding, from its definition.
inline std::vector<std::uint8_t> bytes_of_base64(const std::string& text) {
    const std::string alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::vector<std::uint8_t> bytes;
    std::uint32_t bits = 0, count = 0;
    for (const char c : text) {
        bits = bits << 6 | static_cast<std::uint32_t>(alphabet.find(c));
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes.push_back(static_cast<std::uint8_t>(bits >> count));
    }
    return bytes;
}

inline std::vector<double> values_of(const Picture& picture) {
    const auto bytes = bytes_of_base64(picture.data);
    std::vector<double> values;
    for (std::size_t i = 0; i + 1 < bytes.size(); i += 2)
        values.push_back(value_of_half(static_cast<std::uint16_t>(bytes[i] | bytes[i + 1] << 8)));
    return values;
}

/// Returns the text between `<script ... id="name">` and the first sequence that a browser accepts as its end.
inline std::string script_element(const std::string& html, const std::string& name) {
    const std::size_t begin = html.find('>', html.find("id=\"" + name + "\"")) + 1;
    return html.substr(begin, html.find("</script", begin) - begin);
}

inline void expect_loads_nothing(const std::string& html) {
    const std::regex load(R"re((\b(src|href)\s*=\s*["']|url\(\s*["']?|@import\s*["']?)\s*(https?:)?//)re");
    EXPECT_FALSE(std::regex_search(html, load));
    EXPECT_EQ(html.find("<link"), std::string::npos);
    EXPECT_EQ(html.find("<script src"), std::string::npos);
    EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
}

/// Placeholders are lower-case names or file names.
inline void expect_filled(const std::string& html) {
    std::smatch mark;
    EXPECT_FALSE(std::regex_search(html, mark, std::regex(R"(\{\{[a-z_/]+(\.[a-z]+)?\}\})"))) << mark.str();
    EXPECT_EQ(html.substr(html.size() - 8), "</html>\n");
}

}  // namespace lobelia::test
