// Shader code of spherical harmonics: Y_lm is a polynomial of z times the real or the imaginary part of (x + iy)^m.
#include "core/basis/sh/sh_shader.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/math/ggx_shader.h"
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

/// Writes the harmonics of one direction: polynomials of z times parts of (x + iy)^m.
class Writer {
  public:
    /// Up to degree 2 each subexpression occurs once and is written in place.
    Writer(const std::string& direction, std::size_t degree)
        : x_(direction + ".x"), y_(direction + ".y"), z_(direction + ".z"), in_place_(degree <= 2) {}

    /// The value of `factor` Y_lm, m >= 0, with the real part for `real`, else the imaginary part.
    std::string harmonic(std::size_t l, std::size_t m, bool real, double factor) {
        std::vector<double> p = legendre_derivative(l, m);
        for (double& a : p) a *= factor * norm(l, m);
        if (m == 0) return horner(p);
        // The polynomial belongs to the two harmonics of m and -m: name it if it is a sum.
        if (p.size() > 2) return polynomial_name(l, m, p) + " * " + power(m, real);
        if (m == 2 && in_place_)
            return real ? filled("$0 * ($1 * $1 - $2 * $2)", {horner(p), x_, y_})
                        : filled("$0 * $1 * $2", {literal(2 * p[0]), x_, y_});
        return horner(p) + " * " + power(m, real);
    }
    /// Declarations for a whole direction.
    [[nodiscard]] std::string declarations() const {
        std::string text = squared_ ? filled("    float z2 = $0 * $0;\n", {z_}) : "";
        if (most_ >= 2)
            text += filled(
                "    // Real and imaginary parts of ($0 + i $1)^m.\n    float re_2 = $0 * $0 - $1 * $1;\n"
                "    float im_2 = 2.0 * $0 * $1;\n",
                {x_, y_});
        for (std::size_t m = 3; m <= most_; ++m)
            text += filled("    float re_$2 = $0 * re_$3 - $1 * im_$3;\n    float im_$2 = $0 * im_$3 + $1 * re_$3;\n",
                           {x_, y_, std::to_string(m), std::to_string(m - 1)});
        return text;
    }
    /// Declarations of the polynomials named since the last call.
    [[nodiscard]] std::string named() { return std::exchange(named_, {}); }

  private:
    std::string polynomial_name(std::size_t l, std::size_t m, const std::vector<double>& p) {
        std::string name = "p_" + std::to_string(l) + "_" + std::to_string(m);
        const std::string line = filled("    float $0 = $1;\n", {name, horner(p)});
        if (named_.find(line) == std::string::npos) named_ += line;
        return name;
    }
    /// A polynomial of even or odd powers alone.
    std::string horner(const std::vector<double>& p) {
        const std::size_t degree = p.size() - 1, odd = degree % 2;
        std::string text = literal(p[degree]);
        for (std::size_t k = degree; k >= odd + 2; k -= 2)
            text = (k == degree ? text : "(" + text + ")") + " * " + squared() + added(p[k - 2]);
        if (odd == 0) return text;
        return (degree > 1 ? "(" + text + ")" : text) + " * " + z_;
    }
    std::string squared() {
        if (in_place_) return z_ + " * " + z_;
        squared_ = true;
        return "z2";
    }
    std::string power(std::size_t m, bool real) {
        if (m == 1) return real ? x_ : y_;
        most_ = std::max(most_, m);
        return (real ? "re_" : "im_") + std::to_string(m);
    }

    std::string x_, y_, z_, named_;
    bool in_place_, squared_ = false;
    std::size_t most_ = 1;
};

/// Whether a band's sum is the beginning of its variable.
enum class Sum { begins, goes_on };

/// The terms of one band.
std::string band(Writer& writer, std::size_t l, double factor, const std::string& name, Sum sums) {
    std::string sum;
    for (std::size_t i = l * l; i < (l + 1) * (l + 1); ++i) {
        const std::size_t middle = l * l + l, m = i < middle ? middle - i : i - middle;
        const std::string weight = writer.harmonic(l, m, i >= middle, factor);
        const bool begins = i == l * l && sums == Sum::begins;
        sum += filled(l == 0 ? "    $0$1 $2 $3 * $4;\n" : "    $0$1 $2 $3 * ($4);\n",
                      {begins ? "vec3 " : "", name, begins ? "=" : "+=", coefficient(i), weight});
    }
    const std::string named = writer.named();
    return named + sum;
}

/// The sum of light.c[l^2 + l + m] factors[l] Y_lm at `direction`, as the variable `name`. Leaves out bands whose
/// factor is 0.
ShaderCode sum_of_bands(std::span<const double> factors, const std::string& direction, const std::string& name) {
    std::size_t highest = factors.size() - 1;
    while (highest > 0 && factors[highest] == 0) --highest;
    Writer writer(direction, highest);
    std::string sum;
    for (std::size_t l = 0; l <= highest; ++l)
        if (factors[l] != 0) sum += band(writer, l, factors[l], name, l == 0 ? Sum::begins : Sum::goes_on);
    return {{}, writer.declarations() + sum, name};
}

/// The reflection of a view, a sum of bands at the direction w times the zonal means that `layer_<i>` members hold.
ShaderCode reflected_bands(std::size_t degree, const std::string& layer) {
    Writer writer("w", degree);
    std::string sum = band(writer, 0, 1, "sum", Sum::begins);
    if (degree >= 1) sum += filled("    float root = texels.$00.w * view.alpha;\n", {layer});
    for (std::size_t l = 1; l <= degree; ++l) {
        const std::string name = "band_" + std::to_string(l);
        const std::string mean =
            l == 1 ? "(1.0 - root * root)"
                   : filled("texels.$0$1.$2", {layer, std::to_string((l + 2) / 4), std::string(1, "zwxy"[l % 4])});
        sum += band(writer, l, 1, name, Sum::begins) + filled("    sum += $0 * $1;\n", {mean, name});
    }
    return {{}, writer.declarations() + sum + "    sum = max(texels.view_0.x * sum, vec3(0.0));\n", "sum"};
}

/// The layers of the table that hold the zonal means up to a degree.
std::size_t zonal_layers(std::size_t degree) { return degree < 1 ? 0 : degree < 2 ? 1 : degree < 6 ? 2 : 3; }

}  // namespace

ShaderCode convolved(std::size_t degree) {
    ShaderCode code = reflected_bands(degree, "view_");
    code.functions = ggx_shader::view_functions({std::max<std::size_t>(1, zonal_layers(degree))});
    code.functions.push_back(ggx_shader::axis());
    code.statements =
        "    GgxView view = ggx_view(n, v, alpha);\n"
        "    // Each band in the mean direction of the reflection, times the mean of its Legendre polynomial about "
        "it.\n"
        "    vec3 w = ggx_axis(view, texels.view_0.z);\n" +
        code.statements;
    return code;
}

ShaderCode prefiltered(std::size_t degree) {
    ShaderCode code = reflected_bands(degree, "normal_");
    code.functions = ggx_shader::view_functions({1, zonal_layers(degree)});
    code.functions.push_back(ggx_shader::mirror());
    code.statements =
        "    GgxView view = ggx_view(n, v, alpha);\n"
        "    // Each band in the mirror direction, times the mean of its Legendre polynomial for a view along the "
        "normal.\n"
        "    vec3 w = ggx_mirror(view);\n" +
        code.statements;
    return code;
}

ShaderCode dominant() {
    ShaderCode code{ggx_shader::view_functions({1, 0, ggx_shader::Frame::viewer}),
                    filled(R"(    GgxView view = ggx_view(n, v, alpha);
    // The integrals of L and of w L, the latter by components of w, and the mean direction of the luminance.
    vec3 total = $0 * light.c[0];
    vec3 x = $1 * light.c[3];
    vec3 y = $1 * light.c[1];
    vec3 z = $1 * light.c[2];
    vec3 luminance = vec3(0.2126, 0.7152, 0.0722);
    vec3 mean = vec3(dot(x, luminance), dot(y, luminance), dot(z, luminance));
    float whole = dot(total, luminance);
    float size = length(mean);
    // The lamp in that direction, and the ambient rest; without a direction all is ambient.
    float directed = choose(size > 0.0 && whole > 0.0, 1.0, 0.0);
    vec3 axis = mean * (directed / max(size, 1.0e-30));
    vec3 lamp = clamp(x * axis.x + y * axis.y + z * axis.z, vec3(0.0), max(total, vec3(0.0)));
    vec3 sum = (total - lamp) * ($2 * texels.view_0.x);
    // The lamp's width is unknown but for how far light points at all: make the surface rougher instead.
    float pointing = min(size / max(whole, 1.0e-30), 1.0);
    float rough = min(view.alpha / max(pointing, 1.0e-4), 1.0);
    float masking = ggx_masking(rough * rough, view.cosine * view.cosine);
    sum += lamp * ggx_reflection(view, rough * rough, masking, axis);
)",
                           {literal(std::sqrt(4 * k_pi)), literal(std::sqrt(4 * k_pi / 3)), literal(1 / (4 * k_pi))}),
                    "sum"};
    for (const auto& f : {ggx_shader::sum(), ggx_shader::masking(), ggx_shader::reflection()})
        code.functions.push_back(f);
    return code;
}

ShaderCode radiance(std::size_t degree) {
    ShaderCode code = sum_of_bands(std::vector<double>(degree + 1, 1.0), "w", "sum");
    code.statements =
        "    // light.c[l * l + l + m] belongs to Y_lm of Sloan 2008, with all signs plus.\n" + code.statements;
    return code;
}

ShaderCode irradiance(std::span<const double> factors, const std::string& window) {
    std::string comment = "    // Each band times its factor of the clamped cosine (Ramamoorthi and Hanrahan 2001)";
    if (!window.empty()) comment += "\n    // and of the " + window + " window (Sloan 2008)";
    comment += ".\n";
    if (factors.size() > 3) comment += "    // Odd bands beyond 1 have no irradiance.\n";
    ShaderCode code = sum_of_bands(factors, "n", "e");
    code.statements = comment + code.statements;
    return code;
}

ShaderCode geomerics() {
    return {{},
            filled(R"(    // The length of each channel's vector, and its cosine to the normal.
    vec3 squared = light.c[1] * light.c[1] + light.c[2] * light.c[2] + light.c[3] * light.c[3];
    vec3 over_length = inversesqrt(max(squared, vec3(1.0e-36)));
    vec3 cosine = over_length * (light.c[3] * n.x + light.c[1] * n.y + light.c[2] * n.z);
    // A constant and a power of the cosine (Hazel 2017); the share of directed light is 0 where the mean is negative.
    vec3 share = clamp($0 * squared * over_length / (light.c[0] + 1.0e-30), vec3(0.0), vec3(1.0));
    vec3 power = pow(max(0.5 + 0.5 * cosine, vec3(1.0e-12)), 1.0 + 2.0 * share);
)",
                   {literal(1 / std::sqrt(3.0))}),
            filled("$0 * light.c[0] * ((1.0 - share) / (1.0 + share) + 4.0 * share * power)",
                   {literal(std::sqrt(k_pi) / 2)})};
}

ShaderCode hallucinated() {
    const double band_2 = k_pi / 4 * std::sqrt(5 / (4 * k_pi)) / 2;
    return {{},
            filled(R"(    // The axis of the luminance.
    vec3 luminance = vec3(0.2126, 0.7152, 0.0722);
    vec3 axis = vec3(dot(light.c[3], luminance), dot(light.c[1], luminance), dot(light.c[2], luminance));
    axis *= inversesqrt(max(dot(axis, axis), 1.0e-36));
    // Degree 2, guessed from degree 1 along the axis (Roughton et al. 2024); 0 where the mean is not positive.
    vec3 along = abs(light.c[3] * axis.x + light.c[1] * axis.y + light.c[2] * axis.z);
    along *= sign(max(light.c[0], vec3(0.0)));
    vec3 band_2 = along * (0.08 + 0.6 * along / max(light.c[0], vec3(1.0e-20)));
    float cosine = dot(axis, n);
    vec3 e = light.c[0] * $0;
    e += light.c[1] * ($1 * n.y);
    e += light.c[2] * ($1 * n.z);
    e += light.c[3] * ($1 * n.x);
    e += band_2 * ($2 * cosine * cosine - $3);
)",
                   {literal(std::sqrt(k_pi) / 2), literal(std::sqrt(k_pi / 3)), literal(3 * band_2), literal(band_2)}),
            "e"};
}

ShaderCode zonal(std::span<const double> factors, ZonalAxisCode axis, const std::string& direction) {
    const double y_0 = std::sqrt(1 / (4 * k_pi)), y_1 = std::sqrt(3 / (4 * k_pi)), y_2 = std::sqrt(5 / (4 * k_pi)) / 2;
    const std::string_view of_luminance = R"(    // The axis of the luminance.
    vec3 luminance = vec3(0.2126, 0.7152, 0.0722);
    vec3 axis = vec3(dot(light.c[3], luminance), dot(light.c[1], luminance), dot(light.c[2], luminance));
    float squared = dot(axis, axis);
    float cosine = dot(axis, $0);
    // Degree 1, and degree 2 about the axis, or about z where there is none (Roughton et al. 2024).
    vec3 along = light.c[3] * $0.x + light.c[1] * $0.y + light.c[2] * $0.z;
    float cosine_squared = choose(squared > 0.0, cosine * cosine / max(squared, 1.0e-36), $0.z * $0.z);
    float band_2 = $1 * cosine_squared - $2;
)";
    const std::string_view of_channel = R"(    vec3 along = light.c[3] * $0.x + light.c[1] * $0.y + light.c[2] * $0.z;
    // Degree 2 about the vector of each channel, or about z where there is none (Roughton et al. 2024).
    vec3 squared = light.c[1] * light.c[1] + light.c[2] * light.c[2] + light.c[3] * light.c[3];
    vec3 cosine_squared = mix(vec3($0.z * $0.z), along * along / max(squared, vec3(1.0e-36)), sign(squared));
    vec3 band_2 = $1 * cosine_squared - $2;
)";
    return {{},
            filled(axis == ZonalAxisCode::of_luminance ? of_luminance : of_channel,
                   {direction, literal(3 * factors[2] * y_2), literal(factors[2] * y_2)}),
            filled("$0 * light.c[0] + $1 * along + light.c[4] * band_2",
                   {literal(factors[0] * y_0), literal(factors[1] * y_1)})};
}

}  // namespace lobelia::sh_shader
