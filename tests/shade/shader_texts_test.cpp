// A compiler accepts the shader code of every codec: glslangValidator for GLSL, ESSL and HLSL.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "glslang.h"
#include "shader_runner.h"

namespace lobelia {
namespace {

using shade::Language;

/// Makes one fragment shader of texts that each are whole.
std::string fragment_shader(std::span<const std::string> texts, Language language) {
    std::string shader;
    if (language == Language::glsl) shader = "#version 450\n";
    if (language == Language::essl) shader = "#version 300 es\nprecision highp float;\nprecision highp int;\n";
    for (std::size_t i = 0; i < texts.size(); ++i)
        shader += test::with_own_names(texts[i], "_text_" + std::to_string(i));
    if (language == Language::hlsl) return shader + "float4 main() : SV_Target0 { return (float4)0.0; }\n";
    return shader + (language == Language::glsl ? "layout(location = 0) " : "") +
           "out vec4 colour;\nvoid main() { colour = vec4(0.0); }\n";
}

void expect_accepted(const std::vector<std::string>& texts, Language language) {
    constexpr std::size_t k_batch = 48;
    for (std::size_t begin = 0; begin < texts.size(); begin += k_batch) {
        const auto batch = std::span(texts).subspan(begin, std::min(k_batch, texts.size() - begin));
        if (const Status status = test::check_fragment_shader(fragment_shader(batch, language), language); !status)
            ADD_FAILURE() << info(language).name << ", " << batch.front().substr(0, batch.front().find('\n'))
                          << " and those that follow:\n"
                          << status.error().message;
    }
}

/// Returns texts with all that one can hold: irradiance, radiance and unpacking. Each storage takes its turn.
std::vector<std::string> whole_texts(Language language) {
    std::vector<std::string> texts;
    std::size_t turn = 0;
    for (const auto& name : basis_names()) {
        const auto basis = make_basis(name).value();
        for (const auto& evaluator : basis->evaluator_names()) {
            const Storage& storage = storages()[turn++ % storages().size()];
            std::string encoder = test::encoder_for(name, storage);
            shade::ShaderRequest request{language, {shade::Need::irradiance, shade::Need::radiance}, &storage, {}};
            if (encoder.empty()) {
                request.storage = nullptr;
                encoder = encoder_names(*basis).front();
            }
            auto text = shade::shader_text(make_codec(basis, encoder, evaluator).value(), request);
            if (text) texts.push_back(std::move(text).value());
        }
    }
    return texts;
}

TEST(ShaderTexts, CompilersAcceptThem) {
    if (!test::has_glslang()) GTEST_SKIP() << "no glslangValidator: install glslang-tools";
    for (const Language language : {Language::glsl, Language::essl, Language::hlsl}) {
        std::vector<std::string> texts = whole_texts(language);
        EXPECT_GT(texts.size(), 50u);
        for (const test::ShaderCase& shader : test::shader_cases())
            if (test::unpacks(shader)) texts.push_back(test::text_of(shader, language).value());
        expect_accepted(texts, language);
    }
}

TEST(ShaderTexts, ACompilerRefusesAnUnknownName) {
    if (!test::has_glslang()) GTEST_SKIP() << "no glslangValidator: install glslang-tools";
    for (const Language language : {Language::glsl, Language::essl, Language::hlsl}) {
        const std::vector<std::string> texts = {"float one(float x) {\n    return other(x);\n}\n"};
        EXPECT_FALSE(test::check_fragment_shader(fragment_shader(texts, language), language));
    }
}

TEST(ShaderTexts, OwnNamesAreThoseDeclaredOutermost) {
    const std::string text = "// A lobe.\nconst float k_a = 1.0;\n\nstruct B {\n    vec3 c[4];\n};\nB f(vec3 n) {\n";
    EXPECT_EQ(test::with_own_names(text, "_1"),
              "#define B B_1\n#define f f_1\n#define k_a k_a_1\n" + text + "#undef B\n#undef f\n#undef k_a\n");
}

}  // namespace
}  // namespace lobelia
