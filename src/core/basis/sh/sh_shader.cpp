// Shader code of spherical harmonics: Y_lm is a polynomial of z times the real or the imaginary part of (x + iy)^m.
#include "core/basis/sh/sh_shader.h"

#include <cmath>
#include <utility>
#include <vector>

#include "core/math/shader_pattern.h"
#include "core/math/shader_text.h"
#include "lobelia/math.h"

namespace lobelia::sh_shader {
namespace {

using shader_text::coefficient;
using shader_text::filled;
using shader_text::literal;

/// Coefficients of the m-th derivative of the Legendre polynomial P_l, by powers of z.
std::vector<double> legendre_derivative(std::size_t l, std::size_t m) {
    std::vector<double> before{1}, p{0, 1};
    if (l == 0) p = before;
    for (std::size_t k = 1; k < l; ++k) {
        std::vector<double> next(k + 2);
        const auto n = static_cast<double>(k);
        for (std::size_t i = 0; i < p.size(); ++i) next[i + 1] += (2 * n + 1) / (n + 1) * p[i];
        for (std::size_t i = 0; i < before.size(); ++i) next[i] -= n / (n + 1) * before[i];
        before = std::exchange(p, std::move(next));
    }
    for (std::size_t k = 0; k < m; ++k) {
        for (std::size_t i = 0; i + 1 < p.size(); ++i) p[i] = static_cast<double>(i + 1) * p[i + 1];
        p.pop_back();
    }
    return p;
}

double norm(std::size_t l, std::size_t m) {
    double squared = static_cast<double>(2 * l + 1) / (4 * k_pi) * (m > 0 ? 2 : 1);
    for (std::size_t k = l - m + 1; k <= l + m; ++k) squared /= static_cast<double>(k);
    return std::sqrt(squared);
}

/// " + 1.5" or " - 1.5".
std::string added(double value) { return (value < 0 ? " - " : " + ") + literal(std::abs(value)); }

/// Writes the sums of one direction.
class Writer {
  public:
    explicit Writer(const std::string& direction) : x_(direction + ".x"), y_(direction + ".y"), z_(direction + ".z") {}

    /// The value of `factor` Y_lm, m >= 0, with the real part for `real`, else the imaginary part.
    std::string harmonic(std::size_t l, std::size_t m, bool real, double factor) {
        std::vector<double> p = legendre_derivative(l, m);
        for (double& a : p) a *= factor * norm(l, m);
        const std::string polynomial = horner(p);
        if (m == 0) return polynomial;
        const bool sum = p.size() > 2;
        return (sum ? "(" + polynomial + ")" : polynomial) + " * " + power(m, real);
    }
    /// Declarations of what the harmonics use.
    [[nodiscard]] std::string declarations() const {
        std::string text = squared_ ? "    float z2 = " + z_ + " * " + z_ + ";\n" : "";
        if (most_ >= 2) text += "    // Real and imaginary parts of powers of " + x_ + " + i " + y_ + ".\n";
        for (std::size_t m = 2; m <= most_; ++m)
            text += filled(
                m == 2 ? "    float re_2 = $0 * $0 - $1 * $1;\n    float im_2 = 2.0 * $0 * $1;\n"
                       : "    float re_$2 = $0 * re_$3 - $1 * im_$3;\n    float im_$2 = $0 * im_$3 + $1 * re_$3;\n",
                {x_, y_, std::to_string(m), std::to_string(m - 1)});
        return text;
    }

  private:
    /// A polynomial of even or odd powers alone.
    std::string horner(const std::vector<double>& p) {
        const std::size_t degree = p.size() - 1, odd = degree % 2;
        std::string text = literal(p[degree]);
        for (std::size_t k = degree; k >= odd + 2; k -= 2) {
            squared_ = true;
            text = (k == degree ? text : "(" + text + ")") + " * z2" + added(p[k - 2]);
        }
        if (odd == 0) return text;
        return (degree > 1 ? "(" + text + ")" : text) + " * " + z_;
    }
    std::string power(std::size_t m, bool real) {
        if (m == 1) return real ? x_ : y_;
        most_ = std::max(most_, m);
        return (real ? "re_" : "im_") + std::to_string(m);
    }

    std::string x_, y_, z_;
    bool squared_ = false;
    std::size_t most_ = 1;
};

}  // namespace

ShaderCode sum_of_bands(std::span<const double> factors, const std::string& direction, const std::string& name) {
    Writer writer(direction);
    std::string sum;
    for (std::size_t l = 0; l < factors.size(); ++l) {
        if (factors[l] == 0) continue;
        for (std::size_t i = l * l; i < (l + 1) * (l + 1); ++i) {
            const std::size_t middle = l * l + l, m = i < middle ? middle - i : i - middle;
            const std::string weight = writer.harmonic(l, m, i >= middle, factors[l]);
            sum += (sum.empty() ? "    vec3 " + name + " = " : "    " + name + " += ") + coefficient(i) + " * " +
                   (l > 0 ? "(" + weight + ")" : weight) + ";\n";
        }
    }
    return {{}, writer.declarations() + sum, name};
}

ShaderCode geomerics() {
    return {{},
            R"(    // A mean and a mean direction for each channel (Hazel 2017).
    vec3 size = sqrt(light.c[1] * light.c[1] + light.c[2] * light.c[2] + light.c[3] * light.c[3]);
    vec3 along = (light.c[3] * n.x + light.c[1] * n.y + light.c[2] * n.z) / max(size, vec3(1.0e-20));
    vec3 share = min(size * 0.57735027 / max(light.c[0], vec3(1.0e-30)), vec3(1.0));
    // A constant part, and a power that the direction makes sharper.
    vec3 constant_part = (1.0 - share) / (1.0 + share);
    vec3 power = 1.0 + 2.0 * share;
    vec3 q = max(0.5 + 0.5 * along, vec3(1.0e-12));
)",
            "0.8862269 * light.c[0] * (constant_part + (1.0 - constant_part) * (power + 1.0) * pow(q, power))"};
}

ShaderCode hallucinated() {
    return {{},
            R"(    // The axis of the luminance (Roughton et al. 2024).
    vec3 luminance = vec3(0.2126, 0.7152, 0.0722);
    vec3 axis = vec3(dot(light.c[3], luminance), dot(light.c[1], luminance), dot(light.c[2], luminance));
    axis *= 1.0 / max(length(axis), 1.0e-20);
    // Degree 2, guessed from degree 1 along the axis; 0 for a channel without light.
    vec3 along = abs(light.c[3] * axis.x + light.c[1] * axis.y + light.c[2] * axis.z);
    vec3 lit = clamp(light.c[0] * 1.0e30, vec3(0.0), vec3(1.0));
    vec3 band_2 = lit * along * (0.08 + 0.6 * along / max(light.c[0], vec3(1.0e-20)));
    float cosine = dot(axis, n);
    vec3 e = 0.8862269 * light.c[0];
    e += 1.0233267 * (light.c[3] * n.x + light.c[1] * n.y + light.c[2] * n.z);
    e += band_2 * (0.7431238 * cosine * cosine - 0.2477079);
)",
            "e"};
}

ShaderCode zonal(std::span<const double> factors, ZonalAxisCode axis, const std::string& direction,
                 const std::string& name) {
    const double y_0 = std::sqrt(1 / (4 * k_pi)), y_1 = std::sqrt(3 / (4 * k_pi)), y_2 = std::sqrt(5 / (4 * k_pi)) / 2;
    const std::string d = direction;
    std::string text;
    if (axis == ZonalAxisCode::of_luminance) {
        text = filled(R"(    // The axis of the luminance.
    vec3 luminance = vec3(0.2126, 0.7152, 0.0722);
    vec3 axis = vec3(dot(light.c[3], luminance), dot(light.c[1], luminance), dot(light.c[2], luminance));
    float size = length(axis);
    float cosine = choose(size > 1.0e-30, dot(axis, $0) / max(size, 1.0e-30), $0.z);
    vec3 along = light.c[3] * $0.x + light.c[1] * $0.y + light.c[2] * $0.z;
    float band_2 = $1 * cosine * cosine - $2;
)",
                      {d, literal(3 * factors[2] * y_2), literal(factors[2] * y_2)});
    } else {
        text = filled(R"(    // The cosine to the axis of each channel.
    vec3 along = light.c[3] * $0.x + light.c[1] * $0.y + light.c[2] * $0.z;
    vec3 size = sqrt(light.c[1] * light.c[1] + light.c[2] * light.c[2] + light.c[3] * light.c[3]);
    vec3 cosine = along / max(size, vec3(1.0e-20));
    vec3 band_2 = $1 * cosine * cosine - $2;
)",
                      {d, literal(3 * factors[2] * y_2), literal(factors[2] * y_2)});
    }
    text += filled("    vec3 $0 = $1 * light.c[0] + $2 * along + light.c[4] * band_2;\n",
                   {name, literal(factors[0] * y_0), literal(factors[1] * y_1)});
    return {{}, text, name};
}

}  // namespace lobelia::sh_shader
