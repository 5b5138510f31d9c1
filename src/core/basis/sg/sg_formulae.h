// The formulae of irradiance of a spherical Gaussian, as shader code.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/basis/sg/sg_irradiance.h"
#include "lobelia/shader_code.h"

namespace lobelia::sg_shader {

/// E of a unit lobe as a function of the cosine between normal and axis, and of the constants of its sharpness.
struct Formula {
    std::string_view name;
    std::string_view comment;                 ///< after "/// Returns the irradiance of a lobe"
    std::vector<std::string_view> constants;  ///< names of the constants, in the order of sg_irradiance.cpp
    std::string_view body;                    ///< $0, $1 and so on are the constants
    std::vector<ShaderFunction> functions;    ///< functions that it calls
};
/// Precondition: the kind is not `exact`, which has no formula of fixed length.
[[nodiscard]] const Formula& formula_of(SgIrradiance kind);

/// The function with its constants printed, after those that it calls.
[[nodiscard]] std::vector<ShaderFunction> with_constants(const Formula& formula,
                                                         const std::vector<std::string>& constants);
/// The function with its constants as parameters.
[[nodiscard]] std::vector<ShaderFunction> with_parameters(const Formula& formula);

/// float lobe_irradiance(vec3 axis, vec3 n), `axis` times the sharpness: computes the constants, too. Errors: a kind
/// whose constants are fitted or a series.
[[nodiscard]] Result<std::vector<ShaderFunction>> fitted_functions(SgIrradiance kind);

}  // namespace lobelia::sg_shader
