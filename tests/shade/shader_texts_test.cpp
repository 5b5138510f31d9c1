// Every codec has shader code or a reason why not, and a compiler accepts it: glslangValidator for GLSL, ESSL and HLSL.
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
            shade::ShaderRequest request{language, {shade::Need::irradiance, shade::Need::radiance}, &storage, {}, {}};
            // The specular evaluators take their turns, too.
            if (const auto names = basis->specular_names(); !names.empty()) {
                request.needs.push_back(shade::Need::specular);
                request.specular = names[turn % names.size()];
            }
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

/// Whether a request has a text that says nothing about code that is missing; with the error if not.
testing::AssertionResult has_text(const Codec& codec, const shade::ShaderRequest& request) {
    const auto text = shade::shader_text(codec, request);
    if (!text) return testing::AssertionFailure() << text.error().message;
    if (text->find("has no shader code") != std::string::npos) return testing::AssertionFailure() << *text;
    return testing::AssertionSuccess();
}

TEST(ShaderTexts, EveryCodecHasCodeOrAReason) {
    for (const auto& name : basis_names()) {
        const auto basis = make_basis(name).value();
        for (const auto& evaluator : basis->evaluator_names()) {
            const Codec codec = make_codec(basis, encoder_names(*basis).front(), evaluator).value();
            const bool searches = evaluator == "dering" || (evaluator == "exact" && name.starts_with("sgfit"));
            for (const auto& language : shade::languages()) {
                shade::ShaderRequest request;
                request.language = language.language;
                const auto irradiance = has_text(codec, request);
                EXPECT_NE(searches, static_cast<bool>(irradiance)) << irradiance.message();
                request.needs = {shade::Need::radiance};
                EXPECT_TRUE(has_text(codec, request));
            }
        }
    }
}

TEST(ShaderTexts, EverySpecularEvaluatorHasCodeOrAReason) {
    for (const auto& name : basis_names()) {
        const auto basis = make_basis(name).value();
        const Codec codec = make_codec(basis, encoder_names(*basis).front(), basis->evaluator_names().front()).value();
        shade::ShaderRequest request;
        request.needs = {shade::Need::specular};
        // The default is the most accurate one; where there is none, the error names bases that have one.
        const auto text = shade::shader_text(codec, request);
        const auto names = basis->specular_names();
        if (names.empty())
            EXPECT_NE(text.error().message.find("sh2"), std::string::npos) << text.error().message;
        else
            EXPECT_NE(text.value().find("// Specular: " + names.back() + ";"), std::string::npos) << name;
        for (const auto& specular : specular_names(*basis)) {
            request.specular = specular;
            const auto found = has_text(codec, request);
            EXPECT_EQ(specular != "sampled", static_cast<bool>(found)) << found.message();
        }
        request.specular = "no-such";
        EXPECT_FALSE(has_text(codec, request));
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
