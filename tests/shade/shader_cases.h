// The functions of shader code that tests run, by name, and the texts that hold them.
#pragma once

#include <span>
#include <string>

#include "lobelia/codec.h"
#include "lobelia/storage.h"
#include "shade/shader.h"

namespace lobelia::test {

struct ShaderCase {
    const char* basis;
    const char* part;      ///< the evaluator, or the storage
    const char* function;  ///< "irradiance", "radiance" or "unpack"
    /// The Metal text compiled as C++: evaluates coefficients `c` at the direction `d`, or unpacks the texel `d`.
    void (*call)(const float* c, const float* d, float* out);
};
/// Returns every function of listed bases, evaluators and storages that has code (written by write_shaders.cpp).
[[nodiscard]] std::span<const ShaderCase> shader_cases();

[[nodiscard]] inline bool unpacks(const ShaderCase& shader) { return std::string_view(shader.function) == "unpack"; }

/// The name of the first listed encoder of a basis whose coefficients a storage can hold; empty if there is none.
[[nodiscard]] inline std::string encoder_for(const std::string& basis, const Storage& storage) {
    const auto made = make_basis(basis).value();
    for (const auto& name : encoder_names(*made))
        if (suits(storage, coefficient_traits(*make_encoder(name, made).value()))) return name;
    return {};
}

/// Returns the codec of a case. The text depends on the encoder only by the coefficients that it allows.
[[nodiscard]] inline Codec codec_of(const ShaderCase& shader) {
    const auto basis = make_basis(shader.basis).value();
    const bool stored = unpacks(shader);
    const std::string encoder =
        stored ? encoder_for(shader.basis, *find_storage(shader.part).value()) : encoder_names(*basis).front();
    return make_codec(basis, encoder, stored ? basis->evaluator_names().front() : shader.part).value();
}

/// Returns the text with the function of a case alone. Errors: it has no code.
[[nodiscard]] inline Result<std::string> text_of(const ShaderCase& shader, shade::Language language) {
    shade::ShaderRequest request{language, {}, nullptr, std::nullopt};
    if (unpacks(shader))
        request.storage = find_storage(shader.part).value();
    else
        request.needs = {std::string_view(shader.function) == "radiance" ? shade::Need::radiance
                                                                         : shade::Need::irradiance};
    return shader_text(codec_of(shader), request);
}

}  // namespace lobelia::test
