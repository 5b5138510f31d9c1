// Tests of the translation of shader code into each language, and of what is outside the source language.
#include "shade/translate.h"

#include <gtest/gtest.h>

namespace lobelia::shade {
namespace {

constexpr std::string_view k_source = R"(/// Lobes.
struct Coefficients {
    vec3 c[4];
};

const float k_width = 2.5e-3;

/// Returns the lobe.
float lobe(float cosine, vec3 axis) {
    float rest = 1.0;
    // Keep it away from 0.
    rest -= max(cosine, k_width) * inversesqrt(2.0);
    return choose(rest > 0.5, atan(rest, cosine), mix(rest, dot(axis, vec3(0.0)), 0.5));
}

Coefficients scaled(Coefficients light, vec4 t) {
    Coefficients out_light;
    for (int i = 0; i < 4; i++) {
        out_light.c[i] = light.c[i] * (t.x + float(i));
    }
    if (t.y < 0.0) {
        out_light.c[0] = vec3(t.x * 2.0);
    } else {
        vec3 other = max(light.c[1], vec3(1.0));
        out_light.c[0].x = lobe(0.5, other);
    }
    return out_light;
}
)";

std::string translated(std::string_view source, Language language) {
    const auto text = translate(source, language);
    return text ? *text : "refused: " + text.error().message;
}

TEST(Translate, GlslIsTheSourceButForChoose) {
    std::string expected(k_source);
    const std::string call = "choose(rest > 0.5, atan(rest, cosine), mix(rest, dot(axis, vec3(0.0)), 0.5))";
    expected.replace(expected.find(call), call.size(),
                     "(rest > 0.5 ? atan(rest, cosine) : mix(rest, dot(axis, vec3(0.0)), 0.5))");
    EXPECT_EQ(translated(k_source, Language::glsl), expected);
    EXPECT_EQ(translated(k_source, Language::essl), expected);
}

TEST(Translate, HlslRenamesAndConverts) {
    EXPECT_EQ(translated(k_source, Language::hlsl), R"(/// Lobes.
struct Coefficients {
    float3 c[4];
};

static const float k_width = 2.5e-3;

/// Returns the lobe.
float lobe(float cosine, float3 axis) {
    float rest = 1.0;
    // Keep it away from 0.
    rest -= max(cosine, k_width) * rsqrt(2.0);
    return (rest > 0.5 ? atan2(rest, cosine) : lerp(rest, dot(axis, (float3)0.0), 0.5));
}

Coefficients scaled(Coefficients light, float4 t) {
    Coefficients out_light;
    for (int i = 0; i < 4; i++) {
        out_light.c[i] = light.c[i] * (t.x + float(i));
    }
    if (t.y < 0.0) {
        out_light.c[0] = (float3)(t.x * 2.0);
    } else {
        float3 other = max(light.c[1], (float3)1.0);
        out_light.c[0].x = lobe(0.5, other);
    }
    return out_light;
}
)");
}

TEST(Translate, WgslDeclaresInItsOwnWay) {
    EXPECT_EQ(translated(k_source, Language::wgsl), R"(/// Lobes.
struct Coefficients {
    c: array<vec3f, 4>,
}

const k_width: f32 = 2.5e-3;

/// Returns the lobe.
fn lobe(cosine: f32, axis: vec3f) -> f32 {
    var rest = 1.0;
    // Keep it away from 0.
    rest -= max(cosine, k_width) * inverseSqrt(2.0);
    return select(mix(rest, dot(axis, vec3f(0.0)), 0.5), atan2(rest, cosine), rest > 0.5);
}

fn scaled(light: Coefficients, t: vec4f) -> Coefficients {
    var out_light: Coefficients;
    for (var i = 0; i < 4; i++) {
        out_light.c[i] = light.c[i] * (t.x + f32(i));
    }
    if (t.y < 0.0) {
        out_light.c[0] = vec3f(t.x * 2.0);
    } else {
        let other = max(light.c[1], vec3f(1.0));
        out_light.c[0].x = lobe(0.5, other);
    }
    return out_light;
}
)");
}

TEST(Translate, MetalRenames) {
    const std::string text = translated(k_source, Language::msl);
    EXPECT_NE(text.find("constant float k_width = 2.5e-3;"), std::string::npos) << text;
    EXPECT_NE(text.find("float lobe(float cosine, float3 axis) {"), std::string::npos) << text;
    EXPECT_NE(text.find("(rest > 0.5 ? atan2(rest, cosine) : mix(rest, dot(axis, float3(0.0)), 0.5))"),
              std::string::npos)
        << text;
}

TEST(Translate, WhatIsOutsideTheLanguageIsRefusedWithItsLine) {
    const std::pair<const char*, const char*> cases[] = {
        {"float f(vec3 v) {\n    return v.xy;\n}\n", "line 2: \".xy\" has more than one component"},
        {"float f(float x) {\n    return x > 0.0 ? 1.0 : 2.0;\n}\n", "line 2: the character \"?\""},
        {"float f(inout float x) {\n}\n", "line 1: \"inout\""},
        {"float f(float x) {\n    const float y = 1.0;\n    return x;\n}\n", "line 2: \"const\""},
        {"mat3 m;\n", "line 1: \"mat3\""},
        {"float f() {\n    while (true) { }\n}\n", "line 2: \"while\""}};
    for (const auto& [source, message] : cases)
        for (const auto& language : languages()) {
            const auto text = translate(source, language.language);
            ASSERT_FALSE(text) << *text;
            EXPECT_NE(text.error().message.find(message), std::string::npos) << text.error().message;
        }
}

}  // namespace
}  // namespace lobelia::shade
