// The table of conventions, and conversion by it.
#include "lobelia/sh_conventions.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/math/harmonics.h"
#include "lobelia/codec.h"

namespace lobelia {
namespace {

using Signs = ShConvention::Signs;
using Scale = ShConvention::Scale;
using Functions = ShConvention::Functions;
using Degrees = ShConvention::Degrees;
using Form = ShConvention::Form;

constexpr std::array k_conventions = {
    ShConvention{"directx", "DirectXMath (XMSH): radiance, Condon-Shortley signs", Signs::condon_shortley,
                 Scale::radiance, Functions::orthonormal, Degrees::up_to, 5, Form::channels, ""},
    ShConvention{"unity", "Unity (SphericalHarmonicsL2, SHAr to SHC): E / pi in polynomials", Signs::all_plus,
                 Scale::irradiance_over_pi, Functions::polynomials, Degrees::exactly, 2, Form::unity,
                 "SphericalHarmonicsL2"},
    ShConvention{"three", "three.js (SphericalHarmonics3, LightProbe): radiance", Signs::all_plus, Scale::radiance,
                 Functions::orthonormal, Degrees::exactly, 2, Form::flat, "sh"},
    ShConvention{"filament", "Filament (irradiance(), cmgen --sh-shader): E / pi in polynomials", Signs::all_plus,
                 Scale::irradiance_over_pi, Functions::polynomials, Degrees::exactly, 2, Form::rows, "sh"},
    ShConvention{"gltf", "glTF EXT_lights_image_based: E, Condon-Shortley signs, as Babylon.js reads it",
                 Signs::condon_shortley, Scale::irradiance, Functions::orthonormal, Degrees::exactly, 2, Form::rows,
                 "irradianceCoefficients"},
};

/// l and m of an index l^2 + l + m.
struct DegreeAndOrder {
    std::size_t l;
    int m;
};
DegreeAndOrder degree_and_order(std::size_t index) {
    std::size_t l = 0;
    while ((l + 1) * (l + 1) <= index) ++l;
    return {l, static_cast<int>(index) - static_cast<int>(l * l + l)};
}

/// The factor of a polynomial in its orthonormal function.
double polynomial_factor(std::size_t index) {
    check_range("index of a polynomial", index, 0, 8);
    const double constant = std::sqrt(1 / (4 * k_pi)), linear = std::sqrt(3 / (4 * k_pi)),
                 product = std::sqrt(15 / (4 * k_pi));
    if (index == 0) return constant;
    if (index < 4) return linear;
    return index == 6 ? std::sqrt(5 / (16 * k_pi)) : index == 8 ? product / 2 : product;
}

double scale_of(Scale scale, std::size_t l) {
    switch (scale) {
        case Scale::radiance:
            return 1;
        case Scale::irradiance:
            return harmonics::clamped_cosine(l);
        case Scale::irradiance_over_pi:
            return harmonics::clamped_cosine(l) / k_pi;
    }
    return 1;
}

Rgb scaled(Rgb c, double factor) { return c * static_cast<float>(factor); }

}  // namespace

std::span<const ShConvention> sh_conventions() { return k_conventions; }

Result<const ShConvention*> find_sh_convention(std::string_view name) {
    std::vector<std::string> known;
    for (const ShConvention& convention : k_conventions) {
        if (convention.name == name) return &convention;
        known.emplace_back(convention.name);
    }
    return Error{"unknown convention \"" + std::string(name) + "\"" + nearest_names(name, known)};
}

double sh_factor(const ShConvention& convention, std::size_t index) {
    const auto [l, m] = degree_and_order(index);
    const double sign = convention.signs == Signs::condon_shortley && m % 2 != 0 ? -1 : 1;
    const double norm = convention.functions == Functions::polynomials ? polynomial_factor(index) : 1;
    return sign * scale_of(convention.scale, l) * norm;
}

std::vector<Rgb> exported(const ShConvention& convention, std::span<const Rgb> ours) {
    const std::size_t most = harmonics::coefficient_count(convention.degree);
    const std::size_t count = convention.degrees == Degrees::exactly ? most : std::min(most, ours.size());
    std::vector<Rgb> theirs(count);
    for (std::size_t i = 0; i < std::min(count, ours.size()); ++i)
        theirs[i] = scaled(ours[i], sh_factor(convention, i));
    return theirs;
}

std::vector<Rgb> imported(const ShConvention& convention, std::span<const Rgb> theirs) {
    check_range("coefficients", theirs.size(), 0, harmonics::coefficient_count(convention.degree));
    std::vector<Rgb> ours(theirs.size());
    for (std::size_t i = 0; i < ours.size(); ++i) ours[i] = scaled(theirs[i], 1 / sh_factor(convention, i));
    return ours;
}

std::vector<Rgb> mirrored(std::span<const Rgb> ours, std::size_t axis) {
    check_range("axis", axis, 0, 2);
    // z: Legendre functions of l - |m|; y: the sign of the azimuth; x: the azimuth's distance from half a turn.
    std::vector<Rgb> result(ours.begin(), ours.end());
    for (std::size_t i = 0; i < result.size(); ++i) {
        const auto [l, m] = degree_and_order(i);
        const bool odd_m = m % 2 != 0, negative = m < 0;
        const bool is_odd = axis == 0 ? odd_m != negative : axis == 1 ? negative : (l % 2 != 0) != odd_m;
        if (is_odd) result[i] = result[i] * -1.0f;
    }
    return result;
}

UnityShaderConstants unity_constants(std::span<const Rgb> nine) {
    check_equal("coefficients", nine.size(), 9);
    UnityShaderConstants constants;
    const auto channel = [&](std::size_t i, std::size_t k) {
        return k == 0 ? nine[i].r : k == 1 ? nine[i].g : nine[i].b;
    };
    for (std::size_t k = 0; k < 3; ++k) {
        // The polynomial 3z^2 - 1 gives its constant to A and its square to B.
        const float square = channel(6, k);
        constants.A[k] = {channel(3, k), channel(1, k), channel(2, k), channel(0, k) - square};
        constants.B[k] = {channel(4, k), channel(5, k), 3 * square, channel(7, k)};
        constants.C[k] = channel(8, k);
    }
    constants.C[3] = 1;
    return constants;
}

std::vector<Rgb> coefficients_of(const UnityShaderConstants& constants) {
    std::vector<std::array<float, 3>> nine(9);
    for (std::size_t k = 0; k < 3; ++k) {
        const auto &A = constants.A[k], &B = constants.B[k];
        const float square = B[2] / 3;
        const float channel[9] = {A[3] + square, A[1], A[2], A[0], B[0], B[1], square, B[3], constants.C[k]};
        for (std::size_t i = 0; i < 9; ++i) nine[i][k] = channel[i];
    }
    std::vector<Rgb> result;
    for (const auto& c : nine) result.push_back({c[0], c[1], c[2]});
    return result;
}

}  // namespace lobelia
