// Shader code of octahedral texels: a cell's number from the direction; irradiance with a line for each cell.
#include "core/basis/octahedral_shader.h"

#include "core/basis/direction_text.h"
#include "core/math/shader_pattern.h"
#include "core/math/shader_text.h"

namespace lobelia::octahedral {
namespace {

using shader_text::filled;
using shader_text::literal;

/// WGSL variables of a function share 8192 bytes, of which a coefficient takes 16.
constexpr std::size_t k_most_coefficients = 512;

Status check_count(std::size_t count) {
    if (count <= k_most_coefficients) return Done{};
    return Error{"octahedral texels: shader code is limited to " + std::to_string(k_most_coefficients) +
                 " coefficients, which fit the variables of a shader; " + std::to_string(count) +
                 " do not: use oct22 or coarser, or encode harmonics or lobes"};
}

/// Declares the direction in the frame of the map where it is another than the domain's; returns its name.
std::string turn(const Rotation& map_from_domain, const std::string& direction, std::string& statements) {
    const std::string turned = shader_text::dot_products(direction, map_from_domain);
    if (turned == direction) return direction;
    statements += "    vec3 turned = " + turned + ";\n";
    return "turned";
}

ShaderFunction cell_irradiance() {
    return {"cell_irradiance",
            "/// Returns the irradiance of a cell: of light spread evenly over cosines from t - width to t + width, "
            "where the\n"
            "/// horizon cuts it. Both are times the cell's solid angle.\n"
            "float cell_irradiance(float t, float squared_width) {\n"
            "    float width = sqrt(max(squared_width, 1.0e-12));\n"
            "    float risen = clamp(t + width, 0.0, 2.0 * width);\n"
            "    return risen * risen / (4.0 * width) + max(t - width, 0.0);\n"
            "}\n"};
}

}  // namespace

Result<ShaderCode> radiance_code(const OctahedralTexels& basis) {
    if (Status status = check_count(basis.size()); !status) return status.error();
    const std::size_t resolution = basis.map().resolution;
    ShaderCode code{{octahedral_place_code()}, {}, {}};
    const std::string name = turn(basis.map_from_domain(), "w", code.statements);
    code.statements += filled(
        "    vec2 place = octahedral_place($0);\n"
        "    int column = int(clamp($1 * (place.x + 1.0), 0.0, $2));\n"
        "    int row = int(clamp($1 * (place.y + 1.0), 0.0, $2));\n",
        {name, literal(static_cast<float>(resolution) / 2), literal(static_cast<float>(resolution - 1))});
    code.result = "light.c[" + std::to_string(resolution) + " * row + column]";
    return code;
}

Result<ShaderCode> centroid_code(std::span<const OctahedralTexels::Centroid> cells, const Rotation& map_from_domain) {
    if (Status status = check_count(cells.size()); !status) return status.error();
    ShaderCode code{{cell_irradiance()}, {}, "e"};
    const std::string n = turn(map_from_domain, "n", code.statements);
    code.statements += filled(
        "    // The squared width is a quadratic form of the normal, three times the variance of the cosine.\n"
        "    vec3 squares = $0 * $0;\n"
        "    vec3 products = $0 * vec3($0.y, $0.z, $0.x);\n"
        "    vec3 e = vec3(0.0);\n",
        {n});
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const double omega = cells[i].solid_angle, squared = 3 * omega * omega;
        auto v = cells[i].variance;
        // What is 0 by symmetry, but for rounding.
        for (float& part : v)
            if (std::abs(part) < 1e-7f * (v[0] + v[1] + v[2])) part = 0;
        code.statements += filled("    e += $0 * cell_irradiance(dot($1, $2), dot(squares, $3) + dot(products, $4));\n",
                                  {shader_text::coefficient(i), n, literal(cells[i].mean * cells[i].solid_angle),
                                   literal(squared * v[0], squared * v[1], squared * v[2]),
                                   literal(2 * squared * v[3], 2 * squared * v[4], 2 * squared * v[5])});
    }
    return code;
}

}  // namespace lobelia::octahedral
