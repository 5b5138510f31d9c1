// Shader code of bases, evaluators and pixel formats, in the one source language that src/shade translates to five.
#pragma once

#include <string>
#include <vector>

#include "lobelia/result.h"

namespace lobelia {

/// The source language is a subset of GLSL that GLSL, ESSL, HLSL, WGSL and MSL share, statement by statement:
///
///   types         float, vec2, vec3, vec4, int, bool
///   statements    float x = e;  x = e;  x += e;  -=  *=  if (e) { } else { }  for (int i = 0; i < 4; i++) { }  return
///   e; expressions   + - * /, comparisons of scalars, && || !, calls, light.c[i], one component (v.x, not v.xyz)
///   constructors  one scalar for each component, or one scalar for all of them: vec3(x, y, z), vec3(s)
///   functions     dot cross normalize length min max clamp mix abs sign floor exp exp2 log log2 pow sqrt inversesqrt
///                 sin cos acos atan(y, x), with all arguments of one type; choose(condition, a, b) of scalars: a if
///                 the condition holds, else b
///   literals      floats with a point (1.0, 2.5e-3), whole numbers only as indices and in loops
///
/// Names are snake_case; a name is declared once in a function. Comments are whole lines that begin with //. Four
/// spaces indent a level.

/// A whole function, comment first: "/// Returns ...\nfloat lobe(float cosine) {\n    return ...;\n}\n".
struct ShaderFunction {
    std::string name, text;
    friend bool operator==(const ShaderFunction&, const ShaderFunction&) = default;
};

/// The body of a function of coefficients and a unit direction,
///
///   vec3 radiance(Coefficients light, vec3 w)   or   vec3 irradiance(Coefficients light, vec3 n),
///
/// without clamping: `statements`, then the result. light.c[i] is coefficient i as a vec3.
struct ShaderCode {
    std::vector<ShaderFunction> functions;  ///< functions that it calls, each after those that it calls itself
    std::string statements;                 ///< lines, each indented by four spaces; may be empty
    std::string result;                     ///< an expression of type vec3
};

}  // namespace lobelia
