// Shader code of the irradiance of ambient dice. The functions at a vertex have its symmetry, five mirrors: a value has
// harmonics of the orders 0 and 5 about the vertex, slopes those of 1, 4 and 6, so that 12 vertices share one
// polynomial.
#include <algorithm>

#include "core/basis/ambient_dice_shader.h"
#include "core/basis/direction_text.h"
#include "core/basis/icosahedron.h"
#include "core/math/harmonics.h"
#include "core/math/shader_pattern.h"
#include "core/math/shader_text.h"
#include "core/math/ycocg_shader.h"

namespace lobelia::dice {
namespace {

using icosahedron::vertices;
using shader_text::filled;
using shader_text::literal;

/// The frame of a vertex: itself, the direction of an edge from it, which is a tangent or its opposite, and the other
/// tangent.
struct Frame {
    Vec3 vertex, edge, across;
};
/// Without rounding errors: components are 0, 1 or those of vertices.
Vec3 exact(Vec3 v) {
    const auto nearest = [](float x) {
        for (const float magnitude : {0.0f, vertices()[0].y, vertices()[0].x, 1.0f})
            if (std::abs(std::abs(x) - magnitude) < 1e-5f) return std::copysign(magnitude, x);
        return x;
    };
    return {nearest(v.x), nearest(v.y), nearest(v.z)};
}
Frame frame_of(std::size_t vertex, const std::array<Vec3, 2>& tangents) {
    const Vec3 v = vertices()[vertex];
    for (std::size_t t = 0; t < 2; ++t)
        for (const float sign : {1.0f, -1.0f})
            for (const Vec3& other : vertices()) {
                const Vec3 edge = tangents[t] * sign, across = tangents[1 - t];
                if (dot(other, v) > 0.3f && dot(other, v) < 0.9f && dot(other, edge) > 0 &&
                    std::abs(dot(other, across)) < 1e-5f)
                    return {v, exact(edge), exact(across)};
            }
    contract_violated("a tangent of the dice along an edge");
}

/// Factors of the powers of x from 0 on, of each order: harmonics up to k_degree along a frame as polynomials P_m(x)
/// times the real part of (y + i z)^m. Bands 0, 2, 4, ... and band 1.
struct Polynomials {
    std::array<std::array<double, k_degree + 1>, k_degree + 1> even{}, odd{};
};
Polynomials polynomials(std::span<const float> harmonics_of, const Frame& frame) {
    std::vector<Rgb> c;
    for (const float v : harmonics_of) c.push_back({v, v, v});
    const auto local = harmonics::rotated({frame.edge, cross(frame.vertex, frame.edge), frame.vertex}, c);
    Polynomials result;
    double first = std::sqrt(1 / (4 * k_pi));
    for (std::size_t m = 0; m <= k_degree; ++m) {
        // The recurrence of math/harmonics.cpp.
        const auto mm = static_cast<double>(m);
        if (m > 0) first *= std::sqrt((m == 1 ? 2.0 : 1.0) * (2 * mm + 1) / (2 * mm));
        std::array<double, k_degree + 2> q{first}, previous{};
        for (std::size_t l = m; l <= k_degree; ++l) {
            auto& sum = (l % 2 == 0 ? result.even : result.odd)[m];
            for (std::size_t i = 0; i <= k_degree; ++i) sum[i] += local[l * l + l + m].r * q[i];
            const auto next_l = static_cast<double>(l + 1), below = static_cast<double>(l);
            const double a = std::sqrt((4 * next_l * next_l - 1) / (next_l * next_l - mm * mm));
            const double b = std::sqrt((below * below - mm * mm) / std::max(1.0, 4 * below * below - 1));
            std::array<double, k_degree + 2> next{};
            for (std::size_t i = 0; i <= k_degree; ++i) next[i + 1] = a * q[i];
            for (std::size_t i = 0; i <= k_degree; ++i) next[i] -= a * b * previous[i];
            previous = q;
            q = next;
        }
    }
    return result;
}

/// The code of a polynomial in x of one parity as one in `squared`, by Horner's rule; that of odd ones is over x.
std::string horner(const std::array<double, k_degree + 1>& k, std::size_t parity, std::size_t highest) {
    std::string text = literal(k[parity]);
    std::size_t open = 0;
    for (std::size_t i = parity + 2; i <= highest; i += 2) {
        // A sum is in brackets unless it ends here.
        const bool last = i == highest;
        text += last && k[i] < 0 ? " - squared * " : " + squared * ";
        text += last ? literal(std::abs(k[i])) : "(" + literal(k[i]);
        if (!last) ++open;
    }
    return text + std::string(open, ')');
}

ShaderFunction dice_value(const std::string& name, const std::string& described, const Polynomials& p) {
    return {name,
            filled("/// Returns the irradiance of $0 at a vertex, without band 1, at a normal p: its parts along the\n"
                   "/// vertex, along an edge from it and across both.\n"
                   "float $1(vec3 p) {\n"
                   "    float squared = p.x * p.x;\n"
                   "    float y = p.y * p.y;\n"
                   "    float z = p.z * p.z;\n"
                   "    // The real part of (p.y + i p.z)^5.\n"
                   "    float fifth = p.y * (y * (y - 10.0 * z) + 5.0 * z * z);\n"
                   "    return $2 + p.x * fifth * ($3);\n}\n",
                   {described, name, horner(p.even[0], 0, 8), horner(p.even[5], 1, 3)})};
}

ShaderFunction dice_slopes(const Polynomials& p) {
    return {"dice_slopes",
            filled("/// Returns the irradiance of the slopes along p.y and p.z at a vertex, without band 1.\n"
                   "vec2 dice_slopes(vec3 p) {\n"
                   "    float squared = p.x * p.x;\n"
                   "    // Real and imaginary parts of (p.y + i p.z)^2, ^4 and ^6.\n"
                   "    float c2 = p.y * p.y - p.z * p.z;\n"
                   "    float s2 = 2.0 * p.y * p.z;\n"
                   "    float c4 = c2 * c2 - s2 * s2;\n"
                   "    float s4 = 2.0 * c2 * s2;\n"
                   "    float c6 = c4 * c2 - s4 * s2;\n"
                   "    float s6 = s4 * c2 + c4 * s2;\n"
                   "    float first = p.x * ($0);\n"
                   "    float fourth = $1;\n"
                   "    float sixth = $2;\n"
                   "    return vec2(first * p.y + fourth * c4 + sixth * c6, first * p.z - fourth * s4 + sixth * s6);\n"
                   "}\n",
                   {horner(p.even[1], 1, 7), horner(p.even[4], 0, 4), horner(p.even[6], 0, 2)})};
}

/// The code of a sum of the components of `slopes` along a tangent: "+" or "-", and one component.
std::string along(Vec3 tangent, Vec3 edge, Vec3 across, const std::array<std::string, 2>& slopes) {
    const float e = dot(tangent, edge), a = dot(tangent, across);
    return (std::abs(e) > 0.5f ? (e > 0 ? "+" : "-") + slopes[0] : (a > 0 ? "+" : "-") + slopes[1]);
}

/// Adds the lines of two opposite vertices, front + 1 being the back one. Their bands but 1 are equal, p being turned
/// about for the back one, and mirrored.
class PairLines {
  public:
    PairLines(Chroma chroma, const VertexIrradiance& irradiance, const Rotation& dice_from_domain)
        : chroma_(chroma), irradiance_(irradiance), dice_from_domain_(dice_from_domain) {}

    [[nodiscard]] std::string at(std::size_t vertex) const {
        const Frame frame = frame_of(vertex, irradiance_.tangents_at(vertex));
        const auto turned = [&](Vec3 v) { return shader_text::turned_back(dice_from_domain_, v); };
        const std::string declare = vertex == 0 ? "vec3 " : "";
        std::string text =
            "    // Vertices " + std::to_string(vertex) + " and " + std::to_string(vertex + 1) + ".\n    " + declare +
            "p = " + shader_text::dot_products("n", {turned(frame.vertex), turned(frame.edge), turned(frame.across)}) +
            ";\n" + assign(vertex, "float", "value", "dice_value(p)") +
            assign(vertex, "vec2", "slopes", "dice_slopes(p)");
        if (chroma_ == Chroma::linear) text += assign(vertex, "float", "linear_value", "dice_linear(p)");
        return text + lines(vertex, frame.edge, frame.across, " + ") +
               lines(vertex + 1, frame.edge * -1.0f, frame.across * -1.0f, " - ");
    }

    std::array<std::string, 3> band_1;  ///< factors of p.x for values, of p.y and p.z for slopes, of p.x for chroma

  private:
    static std::string assign(std::size_t vertex, const std::string& type, const std::string& name,
                              const std::string& value) {
        return "    " + (vertex == 0 ? type + " " : "") + name + " = " + value + ";\n";
    }
    [[nodiscard]] std::string lines(std::size_t vertex, Vec3 edge, Vec3 across, const std::string& sign) const {
        const std::string value = "value" + sign + band_1[0] + " * p.x";
        const std::array<std::string, 2> slopes = {"slopes.x" + sign + band_1[1] + " * p.y",
                                                   "slopes.y" + sign + band_1[1] + " * p.z"};
        const auto tangents = irradiance_.tangents_at(vertex);
        std::string text;
        if (chroma_ == Chroma::patches) {
            text += "    e += " + shader_text::coefficient(3 * vertex) + " * (" + value + ");\n";
        } else {
            text += "    chroma_weight = linear_value" + sign + band_1[2] + " * p.x;\n";
            if (vertex == 0) text.insert(4, "float ");
            text += "    e += " + shader_text::coefficient(vertex) + " * vec3(" + value +
                    ", chroma_weight, chroma_weight);\n";
        }
        for (std::size_t t = 0; t < 2; ++t) {
            const std::string slope = along(tangents[t], edge, across, slopes);
            const std::size_t i = 2 * vertex + t;
            const std::string coefficient = chroma_ == Chroma::patches
                                                ? shader_text::coefficient(3 * vertex + 1 + t)
                                                : shader_text::coefficient(12 + i / 3) + "." + "xyz"[i % 3];
            text += (chroma_ == Chroma::patches ? "    e " : "    luma ") + slope.substr(0, 1) + "= " + coefficient +
                    " * (" + slope.substr(1) + ");\n";
        }
        return text;
    }

    Chroma chroma_;
    const VertexIrradiance& irradiance_;
    const Rotation& dice_from_domain_;
};

}  // namespace

ShaderCode convolution_code(Chroma chroma, const VertexIrradiance& irradiance, const Rotation& dice_from_domain) {
    // The functions at vertex 0 in its frame; the slope along the edge is that of a tangent, or less that.
    const auto tangents = irradiance.tangents_at(0);
    const Frame frame = frame_of(0, tangents);
    std::vector<float> slope;
    for (std::size_t i = 0; i < irradiance.first_slope.size(); ++i)
        slope.push_back(dot(frame.edge, tangents[0]) * irradiance.first_slope[i] +
                        dot(frame.edge, tangents[1]) * irradiance.second_slope[i]);
    const Polynomials value = polynomials(irradiance.value, frame), along_edge = polynomials(slope, frame);

    ShaderCode code;
    code.functions = {dice_value("dice_value", "a value", value), dice_slopes(along_edge)};
    PairLines pairs(chroma, irradiance, dice_from_domain);
    pairs.band_1[0] = literal(value.odd[0][1]);
    pairs.band_1[1] = literal(along_edge.odd[1][0]);
    code.statements =
        "    // Bands 0, 2, 4, 6 and 8 are equal on opposite sides, band 1 has opposite signs.\n"
        "    vec3 e = vec3(0.0);\n";
    if (chroma == Chroma::linear) {
        const Polynomials linear = polynomials(irradiance.linear, frame);
        pairs.band_1[2] = literal(linear.odd[0][1]);
        code.functions.push_back(dice_value("dice_linear", "chroma, linear between vertices,", linear));
        code.functions.push_back(shader_text::rgb_from_ycocg());
        code.statements += "    float luma = 0.0;\n";
    }
    for (std::size_t vertex = 0; vertex < vertices().size(); vertex += 2) code.statements += pairs.at(vertex);
    code.result = chroma == Chroma::linear ? "rgb_from_ycocg(e.x + luma, e.y, e.z)" : "e";
    return code;
}

}  // namespace lobelia::dice
