// The functions of shader code that tests run, by name, and the texts that hold them.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "lobelia/codec.h"
#include "lobelia/specular.h"
#include "lobelia/storage.h"
#include "shade/shader.h"

namespace lobelia::test {

struct ShaderCase {
    const char* basis;
    const char* part;      ///< the evaluator, the specular evaluator, or the storage
    const char* function;  ///< "irradiance", "radiance", "specular" or "unpack"
    /// The Metal text compiled as C++: evaluates coefficients `c` at the direction or the point `d`, or unpacks the
    /// texel `d`.
    void (*call)(const float* c, const float* d, float* out);
};
/// Returns every function of listed bases, evaluators and storages that has code (written by write_shaders.cpp).
[[nodiscard]] std::span<const ShaderCase> shader_cases();

[[nodiscard]] inline bool unpacks(const ShaderCase& shader) { return std::string_view(shader.function) == "unpack"; }
[[nodiscard]] inline bool reflects(const ShaderCase& shader) { return std::string_view(shader.function) == "specular"; }

/// A point of specular() as floats: normal, view, alpha, f0.
inline constexpr std::size_t k_point_floats = 10;

/// The table of reflection lobes at (u, v), filtered as a GPU does.
[[nodiscard]] inline std::array<float, 4> sampled_table(std::size_t layer, float u, float v) {
    static const SpecularTable k_table = ggx_table();
    const auto place = [](float coordinate, std::size_t size) {
        const float at = std::clamp(coordinate * static_cast<float>(size) - 0.5f, 0.0f, static_cast<float>(size - 1));
        const std::size_t first = std::min(static_cast<std::size_t>(at), size - 2);
        return std::pair(first, at - static_cast<float>(first));
    };
    const auto [x, along] = place(u, k_table.width);
    const auto [y, down] = place(v, k_table.height);
    const float* corner = &k_table.texels[4 * ((layer * k_table.height + y) * k_table.width + x)];
    std::array<float, 4> value{};
    for (std::size_t k = 0; k < 4; ++k) {
        const float *above = corner + k, *below = above + 4 * k_table.width;
        const float high = above[0] + (above[4] - above[0]) * along, low = below[0] + (below[4] - below[0]) * along;
        value[k] = high + (low - high) * down;
    }
    return value;
}

/// The members of struct GgxTexels, such as "view_0".
[[nodiscard]] inline std::vector<std::string> table_members(const std::string& text) {
    const std::size_t begin = text.find("struct GgxTexels"), end = text.find('}', begin);
    std::vector<std::string> names;
    for (std::size_t at = begin; at < end; ++at)
        for (const std::string_view prefix : {" view_", " normal_"})
            if (text.compare(at, prefix.size(), prefix) == 0) names.push_back(text.substr(at + 1, prefix.size()));
    return names;
}
/// A member's layer of the table, and whether it is sampled for a view along the normal.
[[nodiscard]] inline std::size_t layer_of(const std::string& member) {
    return static_cast<std::size_t>(member.back() - '0');
}
[[nodiscard]] inline bool is_of_normal(const std::string& member) { return member.starts_with("normal"); }

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
    return make_codec(basis, encoder, stored || reflects(shader) ? basis->evaluator_names().front() : shader.part)
        .value();
}

/// Returns the text with the function of a case alone. Errors: it has no code.
[[nodiscard]] inline Result<std::string> text_of(const ShaderCase& shader, shade::Language language) {
    shade::ShaderRequest request;
    request.language = language;
    request.needs.clear();
    if (unpacks(shader)) request.storage = find_storage(shader.part).value();
    if (reflects(shader)) request.specular = shader.part;
    for (const auto& entry : shade::needs())
        if (entry.name == shader.function) request.needs = {entry.need};
    return shader_text(codec_of(shader), request);
}

}  // namespace lobelia::test
