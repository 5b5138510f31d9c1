// Shader code of ambient dice: radiance from the face that a direction is on.
#include "core/basis/ambient_dice_shader.h"

#include "core/basis/direction_text.h"
#include "core/basis/icosahedron.h"
#include "core/math/shader_pattern.h"
#include "core/math/shader_text.h"
#include "core/math/ycocg_shader.h"

namespace lobelia::dice {
namespace {

using shader_text::filled;
using shader_text::literal;

/// Vertices are the cyclic permutations of (+-k_long, +-k_short, 0).
float long_part() { return icosahedron::vertices()[0].x; }
float short_part() { return icosahedron::vertices()[0].y; }

ShaderFunction dice_vertex() {
    return {
        "dice_vertex",
        "/// Returns the number of a vertex: 0 for (+, +, 0), 2 for (0, +, +), 4 for (+, 0, +); 1 more if its longer\n"
        "/// part is below 0, 6 more if its two parts have different signs.\n"
        "int dice_vertex(vec3 v) {\n"
        "    int plane = choose(abs(v.z) < 0.1, 0, choose(abs(v.x) < 0.1, 2, 4));\n"
        "    int opposite = choose(v.x + v.y + v.z < 0.0, 1, 0);\n"
        "    int mirrored = choose(v.x * v.y + v.y * v.z + v.z * v.x < 0.0, 6, 0);\n"
        "    return plane + opposite + mirrored;\n"
        "}\n"};
}

ShaderFunction dice_tangent() {
    return {"dice_tangent",
            "/// Returns the direction of the first slope at a vertex; that of the second is across both.\n"
            "vec3 dice_tangent(vec3 v) {\n"
            "    if (abs(v.z) < 0.5) {\n"
            "        return normalize(vec3(-v.y, v.x, 0.0));\n"
            "    }\n"
            "    return normalize(vec3(0.0, -v.z, v.y));\n"
            "}\n"};
}

ShaderFunction dice_slope() {
    return {"dice_slope",
            "/// Returns a slope of luma; three share a coefficient.\n"
            "float dice_slope(Coefficients light, int i) {\n"
            "    int place = i / 3;\n"
            "    int component = i - 3 * place;\n"
            "    vec3 slopes = light.c[12 + place];\n"
            "    return choose(component == 0, slopes.x, choose(component == 1, slopes.y, slopes.z));\n"
            "}\n"};
}

ShaderFunction dice_corner(Chroma chroma) {
    if (chroma == Chroma::patches)
        return {"dice_corner",
                "/// Returns the part of one corner of a face: its value and its slopes along `across`.\n"
                "vec3 dice_corner(Coefficients light, vec3 v, float value, vec3 across) {\n"
                "    int i = 3 * dice_vertex(v);\n"
                "    vec3 tangent = dice_tangent(v);\n"
                "    return light.c[i] * value + light.c[i + 1] * dot(tangent, across) + light.c[i + 2] * "
                "dot(cross(v, tangent), across);\n"
                "}\n"};
    return {"dice_corner",
            "/// Returns the part of one corner of a face: its luma with the slopes along `across`, its chroma by "
            "`share`.\n"
            "vec3 dice_corner(Coefficients light, vec3 v, float value, vec3 across, float share) {\n"
            "    int i = dice_vertex(v);\n"
            "    vec3 tangent = dice_tangent(v);\n"
            "    vec3 own = light.c[i];\n"
            "    float slopes = dice_slope(light, 2 * i) * dot(tangent, across) + dice_slope(light, 2 * i + 1) * "
            "dot(cross(v, tangent), across);\n"
            "    return vec3(own.x * value + slopes, own.y * share, own.z * share);\n"
            "}\n"};
}

ShaderFunction dice_next() {
    return {"dice_next",
            "/// Returns the components of the next corner, those of the one after this.\n"
            "vec3 dice_next(vec3 v) {\n"
            "    return vec3(v.y, v.z, v.x);\n"
            "}\n"};
}

/// Declares the corners v0, v1, v2 of the face that the direction `w` is on, and its barycentric coordinates b.
std::string face_statements(const std::string& w) {
    const float a = long_part(), b = short_part();
    const Vec3 corners[] = {{a, b, 0}, {0, a, b}, {b, 0, a}}, beyond[] = {{-b, 0, a}, {a, -b, 0}, {0, a, -b}};
    const Vec3 plane = cross(corners[1], corners[2]) * (1 / dot(cross(corners[1], corners[2]), corners[0]));
    // Opposite vertices of two faces sum to this times the ends of their edge.
    const double mean = 2 / (std::sqrt(5.0) + 1);

    std::string text = filled(
        "    // Fold the direction into the first octant; find barycentric coordinates on the face in its middle.\n"
        "    vec3 p = abs($0);\n"
        "    vec3 t = $1 * p + $2 * dice_next(p) - $3 * dice_next(dice_next(p));\n"
        "    vec3 octant = vec3(choose($0.x < 0.0, -1.0, 1.0), choose($0.y < 0.0, -1.0, 1.0), choose($0.z < 0.0, "
        "-1.0, 1.0));\n"
        "    vec3 v0 = octant * $4;\n"
        "    vec3 v1 = octant * $5;\n"
        "    vec3 v2 = octant * $6;\n"
        "    // Where one is below 0 it is the next face, and the corner is beyond the edge.\n",
        {w, literal(plane.x), literal(plane.y), literal(-plane.z), literal(corners[0]), literal(corners[1]),
         literal(corners[2])});
    for (std::size_t k = 0; k < 3; ++k)
        text += filled("    if (t.$0 < 0.0) {\n        v$1 = octant * $2;\n    }\n",
                       {std::string(1, "xyz"[k]), std::to_string(k), literal(beyond[k])});
    return text + filled(
                      "    vec3 below = max(-t, vec3(0.0));\n"
                      "    vec3 b = max(abs(t) - $0 * (dice_next(below) + dice_next(dice_next(below))), "
                      "vec3(0.0));\n",
                      {literal(mean)});
}

/// Declares the weights of values, and those of slopes along the edges from each corner to the next and to the last: as
/// patch_weights() of ambient_dice.cpp, but not yet divided by the sum of values.
std::string patch_statements() {
    const double cosine = 1 / std::sqrt(5.0), across = cosine / (1 + cosine);
    return filled(
        "    // Weights of values and slopes: a cubic whose middle makes slopes meet across the edges.\n"
        "    vec3 b_next = dice_next(b);\n"
        "    vec3 b_last = dice_next(b_next);\n"
        "    vec3 pairs = b_next * b_last;\n"
        "    vec3 middle = pairs * (b.x * pairs.x / max(pairs.x + pairs.y + pairs.z, 1.0e-20));\n"
        "    vec3 middle_next = dice_next(middle);\n"
        "    vec3 middle_last = dice_next(middle_next);\n"
        "    vec3 to_next = b * b * b_next + $0 * middle_next + $1 * middle_last;\n"
        "    vec3 to_last = b * b * b_last + $0 * middle_last + $1 * middle_next;\n"
        "    vec3 value = b * b * b + $2 * (to_next + to_last) - $3 * (middle_next + middle_last);\n"
        "    float whole = value.x + value.y + value.z;\n",
        {literal(cosine), literal(2 * across * (1 - cosine / 2)), literal(3 * cosine), literal(3 * across * cosine)});
}

std::string corner_call(Chroma chroma, std::size_t k) {
    const auto corner = [&](std::size_t i) { return std::to_string((k + i) % 3); };
    return filled("dice_corner(light, v$0, value.$3, v$1 * to_next.$3 + v$2 * to_last.$3$4)",
                  {corner(0), corner(1), corner(2), std::string(1, "xyz"[k]),
                   chroma == Chroma::linear ? std::string(", b.") + "xyz"[k] : ""});
}

}  // namespace

ShaderCode radiance_code(Chroma chroma, const Rotation& dice_from_domain) {
    ShaderCode code;
    code.functions = {dice_next(), dice_vertex(), dice_tangent()};
    if (chroma == Chroma::linear) code.functions.push_back(dice_slope());
    code.functions.push_back(dice_corner(chroma));

    const std::string turned = shader_text::dot_products("w", dice_from_domain);
    const std::string name = turned == "w" ? "w" : "turned";
    if (turned != "w") code.statements += "    vec3 turned = " + turned + ";\n";
    code.statements += face_statements(name) + patch_statements();
    code.statements += "    vec3 sum = " + corner_call(chroma, 0) + ";\n";
    for (std::size_t k = 1; k < 3; ++k) code.statements += "    sum += " + corner_call(chroma, k) + ";\n";

    if (chroma == Chroma::patches) {
        code.result = "sum / whole";
    } else {
        code.functions.push_back(shader_text::rgb_from_ycocg());
        code.statements += "    float shares = b.x + b.y + b.z;\n";
        code.result = "rgb_from_ycocg(sum.x / whole, sum.y / shares, sum.z / shares)";
    }
    return code;
}

}  // namespace lobelia::dice
