// The formulae of irradiance of a spherical Gaussian, as shader code.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/basis/sg/sg_irradiance.h"
#include "lobelia/shader_code.h"

namespace lobelia::sg_shader {

/// Replaces sums of a negative literal by differences: "x + -2.0" becomes "x - 2.0".
void join_signs(std::string& text);

/// Each number as a literal.
[[nodiscard]] std::vector<std::string> literals(std::span<const double> values);

/// E of a unit lobe as a function of the cosine between normal and axis, and of the constants of its sharpness.
struct Formula {
    std::string_view name;
    std::string_view comment;                 ///< after "/// Returns the irradiance of a lobe"
    std::vector<std::string_view> constants;  ///< names of the constants, in the order of folded()
    std::string_view body;                    ///< $0, $1 and so on are the constants, @ the common factor $0
    std::vector<ShaderFunction> functions;    ///< functions that it calls
};
/// Precondition: the kind is not `exact`, which has no formula of fixed length.
[[nodiscard]] const Formula& formula_of(SgIrradiance kind);
/// Returns whether the first constant is a factor of the whole, which with_constants leaves to the caller.
[[nodiscard]] bool has_factor(const Formula& formula);

/// The constants of the formula, from those of a lobe as sg_irradiance.cpp has them.
[[nodiscard]] std::vector<double> folded(SgIrradiance kind, std::span<const float> constants);

/// The functions that the formula calls, for lobes of at least this sharpness.
[[nodiscard]] std::vector<ShaderFunction> functions_of(SgIrradiance kind, float least_sharpness);
/// The function with its constants printed, without the common factor if it has one.
[[nodiscard]] ShaderFunction with_constants(const Formula& formula, const std::vector<std::string>& constants);
/// The function of `meder` for one lobe, from its constants as sg_irradiance.cpp has them.
[[nodiscard]] ShaderFunction meder_function(const std::string& name, std::span<const float> constants);
/// The function with its constants as parameters.
[[nodiscard]] ShaderFunction with_parameters(const Formula& formula);

/// float lobe_irradiance(vec3 axis, vec3 n), `axis` times the sharpness: computes the constants, too. Errors: a kind
/// whose constants are fitted or a series.
[[nodiscard]] Result<std::vector<ShaderFunction>> fitted_functions(SgIrradiance kind);

}  // namespace lobelia::sg_shader
