// Tests SH conventions of other engines: cases computed by hand, each engine's own formula against exact irradiance,
// round trips, mirrored axes, and bad files.
#include "lobelia/sh_conventions.h"

#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>

#include "coefficients/convention_file.h"
#include "core/math/harmonics.h"
#include "support.h"

namespace lobelia {
namespace {

using nlohmann::json;

/// Our coefficients of L = ambient + slope a . d, plus a directional light of irradiance `light` (across its direction)
/// from the unit direction b. Computed with the polynomials: constants integrate to 4 pi, and d_i d_j to 4 pi / 3.
struct DirectionalLights {
    double ambient = 0, slope = 0, light = 0;
    Vec3 a{0, 0, 1}, b{0, 0, 1};

    [[nodiscard]] std::vector<Rgb> coefficients() const {
        const auto Y = harmonics::values(2, b.x, b.y, b.z);
        std::vector<double> c(9);
        c[0] = ambient * std::sqrt(4 * k_pi);
        const double linear = slope * std::sqrt(3 / (4 * k_pi)) * 4 * k_pi / 3;
        c[1] = linear * a.y;
        c[2] = linear * a.z;
        c[3] = linear * a.x;
        std::vector<Rgb> result;
        for (std::size_t i = 0; i < 9; ++i) {
            const auto v = static_cast<float>(c[i] + light * Y[i]);
            result.push_back({v, 2 * v, -0.5f * v});
        }
        return result;
    }
    /// E / pi up to degree 2: a constant sky times 1, a linear sky times 2/3, and the light times the degree-2 clamped
    /// cosine, 1/4 + 1/2 c + 5/32 (3 c^2 - 1), over pi.
    [[nodiscard]] double irradiance_over_pi(Vec3 n) const {
        const double c = dot(b, n);
        return ambient + slope * 2 / 3 * dot(a, n) + light / k_pi * (0.25 + 0.5 * c + 5.0 / 32 * (3 * c * c - 1));
    }
};

std::vector<DirectionalLights> scenes() {
    return {{.ambient = 1},
            {.slope = 1, .a = normalize(Vec3{1, 2, -3})},
            {.light = k_pi, .b = normalize(Vec3{-0.3f, 0.8f, 0.4f})},
            {.ambient = 0.4, .slope = 0.7, .light = 2, .a = {0, 1, 0}, .b = {1, 0, 0}}};
}

const ShConvention& convention(const char* name) { return *find_sh_convention(name).value(); }

// ---- E / pi for one channel by the engines' own formulae, written from their documentation

using Nine = std::array<double, 9>;

Nine green(std::span<const Rgb> c) {
    Nine result{};
    for (std::size_t i = 0; i < 9; ++i) result[i] = c[i].g;
    return result;
}

/// XMSHEvalDirection, multiplied band by band by pi, 2 pi / 3, pi / 4.
double directx(const Nine& c, Vec3 n) {
    const double x = n.x, y = n.y, z = n.z;
    const double functions[9] = {0.282094792,
                                 -0.488602512 * y,
                                 0.488602512 * z,
                                 -0.488602512 * x,
                                 1.092548431 * x * y,
                                 -1.092548431 * y * z,
                                 0.946174696 * z * z - 0.315391565,
                                 -1.092548431 * x * z,
                                 0.546274215 * (x * x - y * y)};
    double sum = 0;
    for (std::size_t i = 0; i < 9; ++i) sum += (i == 0 ? 1 : i < 4 ? 2.0 / 3 : 0.25) * c[i] * functions[i];
    return sum;
}

/// ShadeSH9, with the constants as Unity packs the nine coefficients.
double unity(const Nine& c, Vec3 n) {
    const double x = n.x, y = n.y, z = n.z;
    const double A[4] = {c[3], c[1], c[2], c[0] - c[6]}, B[4] = {c[4], c[5], c[6] * 3, c[7]};
    return A[0] * x + A[1] * y + A[2] * z + A[3] + B[0] * x * y + B[1] * y * z + B[2] * z * z + B[3] * z * x +
           c[8] * (x * x - y * y);
}

/// shGetIrradianceAt, over pi.
double three(const Nine& c, Vec3 n) {
    const double x = n.x, y = n.y, z = n.z;
    return (0.886227 * c[0] + 2 * 0.511664 * (c[1] * y + c[2] * z + c[3] * x) +
            2 * 0.429043 * (c[4] * x * y + c[5] * y * z + c[7] * x * z) + (0.743125 * z * z - 0.247708) * c[6] +
            0.429043 * c[8] * (x * x - y * y)) /
           k_pi;
}

double filament(const Nine& c, Vec3 n) {
    const double x = n.x, y = n.y, z = n.z;
    return c[0] + c[1] * y + c[2] * z + c[3] * x + c[4] * y * x + c[5] * y * z + c[6] * (3 * z * z - 1) + c[7] * z * x +
           c[8] * (x * x - y * y);
}

/// Babylon.js: convertIrradianceToLambertianRadiance, then its functions, which have Condon-Shortley signs.
double babylon(const Nine& c, Vec3 n) {
    const double x = n.x, y = n.y, z = n.z;
    const double functions[9] = {0.282094792,
                                 -0.488602512 * y,
                                 0.488602512 * z,
                                 -0.488602512 * x,
                                 1.092548431 * x * y,
                                 -1.092548431 * y * z,
                                 0.315391565 * (3 * z * z - 1),
                                 -1.092548431 * x * z,
                                 0.546274215 * (x * x - y * y)};
    double sum = 0;
    for (std::size_t i = 0; i < 9; ++i) sum += c[i] / k_pi * functions[i];
    return sum;
}

TEST(ShConventions, EveryTargetsFormulaGivesTheExactIrradiance) {
    const std::map<std::string_view, std::function<double(const Nine&, Vec3)>> formulae = {
        {"directx", directx}, {"unity", unity}, {"three", three}, {"filament", filament}, {"gltf", babylon}};
    const Directions normals = test::random_directions(Domain::sphere, 50, 3);
    for (const ShConvention& target : sh_conventions()) {
        ASSERT_TRUE(formulae.contains(target.name)) << target.name << " has no formula here";
        for (const DirectionalLights& scene : scenes()) {
            const Nine theirs = green(exported(target, scene.coefficients()));
            for (std::size_t i = 0; i < normals.size(); ++i) {
                const Vec3 n = direction_at(normals, i);
                EXPECT_NEAR(formulae.at(target.name)(theirs, n), 2 * scene.irradiance_over_pi(n), 2e-5) << target.name;
            }
        }
    }
}

// ---- Known answers

void expect_coefficients(const char* name, const DirectionalLights& scene, const Nine& expected) {
    const Nine found = green(exported(convention(name), scene.coefficients()));
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(found[i], 2 * expected[i], 2e-6) << name << " " << i;
}

TEST(ShConventions, AConstantSky) {
    const DirectionalLights one{.ambient = 1};
    const double c0 = 2 * std::sqrt(k_pi);
    expect_coefficients("directx", one, {c0});
    expect_coefficients("three", one, {c0});
    expect_coefficients("unity", one, {1});
    expect_coefficients("filament", one, {1});
    expect_coefficients("gltf", one, {k_pi * c0});
}

TEST(ShConventions, ALinearSky) {
    // L = y: c_1 = sqrt(4 pi / 3), E / pi = 2/3 y.
    const DirectionalLights up{.slope = 1, .a = {0, 1, 0}};
    const double c1 = std::sqrt(4 * k_pi / 3);
    expect_coefficients("directx", up, {0, -c1});
    expect_coefficients("three", up, {0, c1});
    expect_coefficients("unity", up, {0, 2.0 / 3});
    expect_coefficients("filament", up, {0, 2.0 / 3});
    expect_coefficients("gltf", up, {0, -2 * k_pi / 3 * c1});
}

TEST(ShConventions, ADirectionalLight) {
    // A light of irradiance pi from +z: Y at the pole times pi; E / pi = 1/4 + z / 2 + 5/32 (3 z^2 - 1).
    const DirectionalLights pole{.light = k_pi, .b = {0, 0, 1}};
    const double Y0 = std::sqrt(1 / (4 * k_pi)), Y1 = std::sqrt(3 / (4 * k_pi)), Y2 = std::sqrt(5 / (4 * k_pi));
    expect_coefficients("directx", pole, {k_pi * Y0, 0, k_pi * Y1, 0, 0, 0, k_pi * Y2});
    expect_coefficients("three", pole, {k_pi * Y0, 0, k_pi * Y1, 0, 0, 0, k_pi * Y2});
    expect_coefficients("unity", pole, {0.25, 0, 0.5, 0, 0, 0, 5.0 / 32});
    expect_coefficients("filament", pole, {0.25, 0, 0.5, 0, 0, 0, 5.0 / 32});
    // A light from +x: Condon-Shortley signs show in index 3; xy, yz and xz vanish; x^2 - y^2 is 1.
    const DirectionalLights right{.light = k_pi, .b = {1, 0, 0}};
    const double k8 = k_pi * std::sqrt(15 / (16 * k_pi)), k6 = -k_pi * std::sqrt(5 / (16 * k_pi));
    expect_coefficients("directx", right, {k_pi * Y0, 0, 0, -k_pi * Y1, 0, 0, k6, 0, k8});
    expect_coefficients("unity", right, {0.25, 0, 0, 0.5, 0, 0, -5.0 / 64, 0, 15.0 / 64});
}

TEST(ShConventions, UnityShaderConstants) {
    const auto nine = exported(convention("unity"), DirectionalLights{.light = k_pi, .b = {0, 0, 1}}.coefficients());
    const UnityShaderConstants constants = unity_constants(nine);
    const std::array<float, 4> A = {0, 0, 1, 2 * (0.25f - 5.0f / 32)}, B = {0, 0, 2 * 15.0f / 32, 0};
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(constants.A[1][i], A[i], 1e-6);
        EXPECT_NEAR(constants.B[1][i], B[i], 1e-6);
    }
    EXPECT_EQ(constants.C[3], 1);
    const auto back = coefficients_of(constants);
    for (std::size_t i = 0; i < 9; ++i) EXPECT_LE(test::norm(back[i] - nine[i]), 1e-6);
}

// ---- Round trips

TEST(ShConventions, RoundTripThroughFiles) {
    for (const ShConvention& target : sh_conventions()) {
        SCOPED_TRACE(target.name);
        for (const std::size_t count : {4u, 9u, 36u}) {
            const auto ours = test::random_colours(count, 1);
            const auto theirs = exported(target, ours);
            for (const int indent : {-1, 2}) {
                const auto read = convention_from_text(target, to_json(target, theirs).dump(indent), "f.json");
                ASSERT_TRUE(read) << read.error().message;
                const auto back = imported(target, *read);
                const std::size_t kept = std::min(count, harmonics::coefficient_count(target.degree));
                ASSERT_GE(back.size(), kept);
                for (std::size_t i = 0; i < back.size(); ++i)
                    EXPECT_LE(test::norm(back[i] - (i < kept ? ours[i] : Rgb{})), 1e-6) << i;
            }
        }
    }
}

TEST(ShConventions, OtherFormsOfFilesAreRead) {
    // Unity's shader constants alone.
    const auto ours = test::random_colours(9, 2);
    json constants = to_json(convention("unity"), exported(convention("unity"), ours));
    constants.erase("SphericalHarmonicsL2");
    const auto unity_back = convention_from_text(convention("unity"), constants.dump(), "u.json");
    ASSERT_TRUE(unity_back);
    for (std::size_t i = 0; i < 9; ++i)
        EXPECT_LE(test::norm(imported(convention("unity"), *unity_back)[i] - ours[i]), 3e-6);

    // A glTF file, with its intensity.
    json light = to_json(convention("gltf"), exported(convention("gltf"), ours));
    light["intensity"] = 2;
    const json file = {{"asset", {{"version", "2.0"}}},
                       {"extensions", {{"EXT_lights_image_based", {{"lights", json::array({light})}}}}}};
    const auto gltf_back = convention_from_text(convention("gltf"), file.dump(), "scene.gltf");
    ASSERT_TRUE(gltf_back) << gltf_back.error().message;
    for (std::size_t i = 0; i < 9; ++i)
        EXPECT_LE(test::norm(imported(convention("gltf"), *gltf_back)[i] - ours[i] * 2.0f), 3e-6);

    // A light probe of three.js, as its toJSON() nests it.
    const json probe = {{"object", to_json(convention("three"), ours)}};
    ASSERT_TRUE(convention_from_text(convention("three"), probe.dump(), "probe.json"));

    // cmgen's text.
    std::string text = "// a comment\n";
    for (const Rgb& c : ours)
        text += "( " + std::to_string(c.r) + ",  " + std::to_string(c.g) + ", " + std::to_string(c.b) + "); // L\n";
    const auto filament_back = convention_from_text(convention("filament"), text, "sh.txt");
    ASSERT_TRUE(filament_back) << filament_back.error().message;
    for (std::size_t i = 0; i < 9; ++i) EXPECT_LE(test::norm((*filament_back)[i] - ours[i]), 2e-6);
}

TEST(ShConventions, MirroredWorlds) {
    const auto c = test::random_colours(25, 3);
    const Directions directions = test::random_directions(Domain::sphere, 20, 4);
    const auto radiance = [](std::span<const Rgb> of, Vec3 d) {
        const auto Y = harmonics::values(4, d.x, d.y, d.z);
        double sum = 0;
        for (std::size_t i = 0; i < of.size(); ++i) sum += of[i].g * Y[i];
        return sum;
    };
    for (const std::size_t axis : {0, 1, 2}) {
        const auto turned = mirrored(c, axis);
        for (std::size_t i = 0; i < directions.size(); ++i) {
            const Vec3 d = direction_at(directions, i);
            const Vec3 there{axis == 0 ? -d.x : d.x, axis == 1 ? -d.y : d.y, axis == 2 ? -d.z : d.z};
            EXPECT_NEAR(radiance(turned, there), radiance(c, d), 1e-5) << axis;
        }
        EXPECT_EQ(mirrored(turned, axis), c);
    }
}

// ---- Bad files

void expect_refused(const char* name, const std::string& text, const std::string& part) {
    const auto read = convention_from_text(convention(name), text, "folder/f.json");
    ASSERT_FALSE(read) << name << ": " << text;
    EXPECT_TRUE(read.error().message.starts_with("folder/f.json:")) << read.error().message;
    EXPECT_NE(read.error().message.find(part), std::string::npos) << read.error().message;
}

TEST(ShConventions, BadFilesNameTheFileAndThePlace) {
    for (const ShConvention& target : sh_conventions()) {
        const char* name = target.name.data();
        expect_refused(name, "", "byte");
        expect_refused(name, "[1, 2", "byte 6");
        expect_refused(name, "[]", "not a JSON object");
        expect_refused(name, "{}", "");
        expect_refused(name, R"({"convention": "another"})", "another");
        const json good = to_json(target, exported(target, test::random_colours(9, 5)));
        for (const auto& [key, value] : good.items()) {
            if (key == "convention" || (target.form == ShConvention::Form::unity && key != "SphericalHarmonicsL2"))
                continue;
            json spoiled = good;
            spoiled[key].erase(0);
            expect_refused(name, spoiled.dump(), "");
            spoiled = good;
            (spoiled[key][0].is_array() ? spoiled[key][0][0] : spoiled[key][0]) = "1";
            expect_refused(name, spoiled.dump(), "[0]");
            spoiled = good;
            (spoiled[key][1].is_array() ? spoiled[key][1][0] : spoiled[key][1]) = 1e300;
            expect_refused(name, spoiled.dump(), "[1]");
            spoiled = good;
            spoiled[key] = {{"a", 1}};
            expect_refused(name, spoiled.dump(), "");
        }
    }
    expect_refused("filament", "(1, 2, 3);\n(1, 2);\n", "");
    expect_refused("filament", "(1, 2, 3);\n(1, nan, 2);\n", "f.json:2");
    expect_refused("filament", "(1, 2, 3);\n", "9 coefficients");
    const std::string deep(100000, '[');
    expect_refused("gltf", "{\"irradianceCoefficients\": " + deep, "nests more than 64 levels deep");
    expect_refused("gltf", "{\"irradianceCoefficients\": " + deep + std::string(deep.size(), ']') + "}", "");
    EXPECT_FALSE(find_sh_convention("unreal"));
}

}  // namespace
}  // namespace lobelia
