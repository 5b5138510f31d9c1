// Shader code compiled as C++, by name (write_shaders.cpp).
#pragma once

#include <span>
#include <string>

#include "lobelia/codec.h"
#include "lobelia/storage.h"

namespace lobelia::test {

struct ShaderCase {
    const char* basis;
    const char* part;      ///< the evaluator, or the storage
    const char* function;  ///< "irradiance", "radiance" or "unpack"
    /// Evaluates coefficients `c` at the direction `d`, or unpacks the texel `d`.
    void (*call)(const float* c, const float* d, float* out);
};
[[nodiscard]] std::span<const ShaderCase> shader_cases();

/// The name of the first listed encoder of a basis whose coefficients a storage can hold; empty if there is none.
[[nodiscard]] inline std::string encoder_for(const std::string& basis, const Storage& storage) {
    const auto made = make_basis(basis).value();
    for (const auto& name : encoder_names(*made))
        if (suits(storage, coefficient_traits(*make_encoder(name, made).value()))) return name;
    return {};
}

}  // namespace lobelia::test
