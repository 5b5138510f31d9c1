// ShaderParity: the shader code of every basis, evaluator and storage gives what the library gives: Metal's text
// compiled as C++, GLSL and HLSL on a Vulkan driver. WGSL is translated from the same source, word by word.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <regex>
#include <set>

#include "glossy_points.h"
#include "lobelia/codec.h"
#include "lobelia/environment.h"
#include "lobelia/sky.h"
#include "lobelia/specular.h"
#include "lobelia/storage.h"
#include "shader_runner.h"
#include "support.h"

namespace lobelia {
namespace {

constexpr std::size_t k_texels = 64, k_normals = 4096;
/// Difference from the library relative to the largest channel of a texel.
constexpr double k_allowed = 2e-5;

/// Coefficients of texels: of the sky seen by few and by many samples, from turned sides, some with noise of both
/// signs.
std::vector<std::vector<Rgb>> texels_of(const Encoder& encoder, std::size_t count) {
    std::mt19937 generator(5);
    std::normal_distribution<float> noise(0, 1);
    const Image environment = sky({64, 32});
    std::vector<std::vector<Rgb>> texels;
    for (std::size_t i = 0; i < count; ++i) {
        const auto directions =
            test::random_directions(encoder.basis().domain(), 32 + 16 * i, static_cast<std::uint32_t>(i));
        Accumulator accumulator{std::shared_ptr<const Encoder>(std::shared_ptr<void>(), &encoder)};
        accumulator.add(directed_samples(environment, directions, encoder.basis().domain()));
        auto c = accumulator.solve();
        const auto meanings = encoder.basis().meanings();
        if (i % 8 == 7 && !coefficient_traits(encoder).non_negative)
            for (std::size_t k = 0; k < c.size(); ++k)
                if (meanings[k] == Meaning::light) c[k] = c[k] + Rgb{1, 1, 1} * (0.1f * c[0].g * noise(generator));
        texels.push_back(std::move(c));
    }
    return texels;
}

/// The largest difference within each texel, relative to the largest value expected there; infinite where a value is
/// NaN.
std::vector<double> differences(std::span<const float> found, std::span<const float> expected, std::size_t texels) {
    const std::size_t size = expected.size() / texels;
    std::vector<double> result;
    for (std::size_t i = 0; i < texels; ++i) {
        double largest = 1e-30, off = 0;
        for (std::size_t j = i * size; j < (i + 1) * size; ++j) {
            largest = std::max(largest, std::abs(static_cast<double>(expected[j])));
            const double error = std::abs(static_cast<double>(found[j]) - expected[j]);
            off = error <= off ? off : std::isnan(error) ? HUGE_VAL : error;
        }
        result.push_back(off / largest);
    }
    return result;
}

double largest(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }

std::string name_of(const test::ShaderCase& shader) {
    return std::string(shader.basis) + " " + shader.part + " " + shader.function;
}

/// The ways to run shader code.
struct Runners {
    Runners() {
        for (const shade::Language language : {shade::Language::glsl, shade::Language::hlsl})
            if (auto runner = test::VulkanRunner::open(language)) on_vulkan.push_back(std::move(runner).value());
    }
    /// Returns a column for each way: the difference of each texel.
    std::vector<std::vector<double>> columns(const test::ShaderCase& shader, const test::ShaderInput& input,
                                             const std::vector<float>& expected) {
        std::vector<std::vector<double>> all = {
            differences(test::run_msl_as_cpp(shader, input), expected, input.texels)};
        if (!test::runs_on_vulkan(shader)) return all;
        for (auto& runner : on_vulkan) {
            const auto found = runner->run(shader, input);
            if (!found) ADD_FAILURE() << found.error().message;
            all.push_back(found ? differences(*found, expected, input.texels) : std::vector<double>(input.texels));
        }
        return all;
    }
    std::vector<std::unique_ptr<test::VulkanRunner>> on_vulkan;
};
constexpr std::array k_columns = {"msl", "glsl", "hlsl"};

/// Values of a function at texels, and what the library gives, texel by texel, direction by direction.
struct Evaluation {
    test::ShaderInput input;
    std::vector<float> expected;
};
Evaluation evaluation_of(const test::ShaderCase& shader, const std::vector<std::vector<Rgb>>& texels,
                         std::size_t count) {
    const Codec codec = test::codec_of(shader);
    Evaluation result;
    result.input.texels = texels.size();
    result.input.directions = count;
    for (const auto& c : texels) result.input.values.insert(result.input.values.end(), &c[0].r, &c[0].r + 3 * c.size());

    std::shared_ptr<const SpecularEvaluator> evaluator;
    const test::GlossyPoints points(codec.basis().domain(), count);
    if (test::reflects(shader)) {
        evaluator = make_specular(shader.part, make_basis(shader.basis).value()).value();
        result.input.xyz = points.floats();
    } else {
        for (std::size_t j = 0; j < count; ++j) {
            const Vec3 d = direction_at(points.normals, j);
            result.input.xyz.insert(result.input.xyz.end(), {d.x, d.y, d.z});
        }
    }
    Colours values(count);
    for (const auto& c : texels) {
        if (evaluator)
            specular(*evaluator, c, points.points(), points.f0, values);
        else if (std::string_view(shader.function) == "irradiance")
            codec.irradiance(c, points.normals, values);
        else
            codec.radiance(c, points.normals, values);
        for (std::size_t j = 0; j < count; ++j)
            for (std::size_t k = 0; k < 3; ++k) result.expected.push_back(values.channel(k)[j]);
    }
    return result;
}

/// Axes that code computes from coefficients are off by a rounding of their last digits. A reflection at a grazing
/// angle sees h = v + axis, of a length of a hundredth, so much less precisely.
double allowed_for(const test::ShaderCase& shader) {
    const auto meanings = make_basis(shader.basis).value()->meanings();
    const bool computes_axes = std::count(meanings.begin(), meanings.end(), Meaning::shape) > 0 ||
                               std::string_view(shader.part) == "sh-dominant";
    return test::reflects(shader) && computes_axes ? 1.5e-4 : k_allowed;
}

void print_row(const std::string& name, std::span<const double> worst) {
    std::printf("%-48s", name.c_str());
    for (const double value : worst) std::printf(" %8.1e", value);
    std::printf("\n");
}

TEST(ShaderParity, VulkanRuns) {
    const auto runner = test::VulkanRunner::open(shade::Language::glsl);
    if (!runner) GTEST_SKIP() << "GLSL and HLSL are not run here: " << runner.error().message;
    std::printf("%s\n", runner.value()->device().c_str());
}

TEST(ShaderParity, FunctionsGiveWhatTheLibraryGives) {
    Runners runners;
    std::string basis;
    std::vector<std::vector<Rgb>> texels;
    std::printf("%-48s %8s %8s %8s\n", "", k_columns[0], k_columns[1], k_columns[2]);
    for (const test::ShaderCase& shader : test::shader_cases()) {
        if (test::unpacks(shader)) continue;
        const Codec codec = test::codec_of(shader);
        // Large maps of texels take long to sum up.
        const bool large = codec.basis().size() > 100;
        if (std::exchange(basis, shader.basis) != shader.basis)
            texels = texels_of(*codec.encoder(), large ? 4 : k_texels);
        const auto [input, expected] = evaluation_of(shader, texels, large ? 256 : k_normals);
        const auto columns = runners.columns(shader, input, expected);
        std::vector<double> worst;
        for (std::size_t k = 0; k < columns.size(); ++k) {
            worst.push_back(largest(columns[k]));
            EXPECT_LT(worst.back(), allowed_for(shader)) << name_of(shader) << ", " << k_columns[k];
        }
        print_row(name_of(shader), worst);
    }
}

TEST(ShaderParity, AWrongSignIsFoundInEveryWay) {
    Runners runners;
    for (const test::ShaderCase& shader : test::shader_cases()) {
        if (test::unpacks(shader) || std::string_view(shader.basis) != "sh1") continue;
        auto texels = texels_of(*test::codec_of(shader).encoder(), 4);
        const auto expected = evaluation_of(shader, texels, 64).expected;
        for (auto& c : texels) c[1] = c[1] * -1.0f;
        for (const auto& column : runners.columns(shader, evaluation_of(shader, texels, 64).input, expected))
            for (const double difference : column) EXPECT_GT(difference, 1e-2) << shader.part << " " << shader.function;
    }
}

/// Turns the sign of the first constant of at least 0.1 that is a part of the function's sum.
std::string with_a_wrong_sign(std::string text) {
    static const std::regex sum(R"( (e|sum) = )"), number(R"([0-9]+\.[0-9]+)");
    std::smatch at;
    if (!std::regex_search(text, at, sum)) return text;
    for (std::sregex_iterator i(text.cbegin() + at.position(), text.cend(), number), end; i != end; ++i)
        if (std::stod(i->str()) >= 0.1)
            return text.replace(static_cast<std::size_t>(at.position() + i->position()), i->str().size(),
                                "(-" + i->str() + ")");
    return text;
}

TEST(ShaderParity, AWrongSignInTheTextIsFound) {
    const std::set<std::pair<std::string_view, std::string_view>> cases = {
        {"sh1", "convolution"},    {"h6", "exact"},           {"sg12", "hill"},    {"sg12", "two-ends"},
        {"sh2", "sh-convolution"}, {"sh2", "sh-prefiltered"}, {"sg12", "asg-warp"}};
    for (const shade::Language language : {shade::Language::glsl, shade::Language::hlsl}) {
        const auto runner = test::VulkanRunner::open(language);
        if (!runner) GTEST_SKIP() << runner.error().message;
        for (const test::ShaderCase& shader : test::shader_cases()) {
            if (!cases.contains({shader.basis, shader.part}) || std::string_view(shader.function) == "radiance")
                continue;
            const auto texels = texels_of(*test::codec_of(shader).encoder(), 8);
            const auto [input, expected] = evaluation_of(shader, texels, 256);
            const std::string text = test::text_of(shader, language).value();
            const auto right = runner.value()->run(shader, text, input);
            const auto wrong = runner.value()->run(shader, with_a_wrong_sign(text), input);
            ASSERT_TRUE(right) << right.error().message;
            ASSERT_TRUE(wrong) << wrong.error().message;
            EXPECT_LT(largest(differences(*right, expected, texels.size())), k_allowed) << name_of(shader);
            EXPECT_GT(largest(differences(*wrong, expected, texels.size())), 1e-2) << name_of(shader);
        }
    }
}

/// Appends the values of a texture as graphics interfaces give them at one texel, four a texel, and the scale where the
/// code asks for it.
void append_sampled(std::vector<float>& texel, const TextureLayout::Texture& layout, const PackedTexture& packed,
                    std::span<const std::vector<float>> channels, std::size_t place) {
    float values[4] = {0, 0, 0, 1};
    const bool decoded_by_shader = decode_function(layout.format) != nullptr;
    for (std::size_t k = 0; k < 4; ++k)
        if (decoded_by_shader)
            values[k] = static_cast<float>(std::to_integer<int>(packed.data[4 * place + k])) / 255;
        else if (k < channels.size())
            values[k] = channels[k][place] * packed.scale;
    texel.insert(texel.end(), values, values + 4);
    if (decoded_by_shader) texel.push_back(packed.scale);
}

/// Returns the values of Texel at each place of a page.
std::vector<float> sampled(const TextureLayout& layout, std::span<const PackedTexture> packed, std::size_t side) {
    std::vector<std::vector<std::vector<float>>> decoded;
    for (std::size_t t = 0; t < packed.size(); ++t) {
        decoded.emplace_back(info(layout.textures[t].format).channels,
                             std::vector<float>(packed[t].width * packed[t].height));
        std::vector<float*> pointers;
        for (auto& channel : decoded.back()) pointers.push_back(channel.data());
        decode_texels(layout.textures[t].format, packed[t].width, packed[t].height, packed[t].data, pointers);
    }
    std::vector<float> values;
    for (std::size_t i = 0; i < side * side; ++i)
        for (std::size_t t = 0; t < packed.size(); ++t) {
            const std::size_t step = layout.textures[t].subsampling, x = i % side / step, y = i / side / step;
            append_sampled(values, layout.textures[t], packed[t], decoded[t], y * packed[t].width + x);
        }
    return values;
}

TEST(ShaderParity, UnpackingGivesWhatTheLibraryUnpacks) {
    constexpr std::size_t side = 8;
    Runners runners;
    std::map<std::string, std::vector<double>> worst_of;
    std::map<std::string, std::vector<std::vector<Rgb>>> texels_by_encoder;
    for (const test::ShaderCase& shader : test::shader_cases()) {
        if (!test::unpacks(shader)) continue;
        const Codec codec = test::codec_of(shader);
        const std::size_t planes = 3 * codec.basis().size();
        auto& texels = texels_by_encoder[codec.name().basis + "/" + codec.name().encoder];
        if (texels.empty()) texels = texels_of(*codec.encoder(), planes > 300 ? 4 : side * side);
        const TextureLayout layout = find_storage(shader.part).value()->layout(coefficient_traits(*codec.encoder()));

        // Pack a page and unpack it again.
        std::vector<std::vector<float>> page(planes, std::vector<float>(side * side)), unpacked = page;
        for (std::size_t p = 0; p < planes; ++p)
            for (std::size_t i = 0; i < side * side; ++i) page[p][i] = (&texels[i % texels.size()][0].r)[p];
        const auto packed = pack(layout, CoefficientPlanes(side, side, std::span(page), planes / 3));
        unpack(layout, packed, MutableCoefficientPlanes(side, side, std::span(unpacked), planes / 3));

        test::ShaderInput input;
        input.texels = side * side;
        input.values = sampled(layout, packed, side);
        input.results = planes;
        std::vector<float> expected;
        for (std::size_t i = 0; i < side * side; ++i)
            for (std::size_t p = 0; p < planes; ++p) expected.push_back(unpacked[p][i]);
        const auto columns = runners.columns(shader, input, expected);
        auto& worst = worst_of[shader.part];
        worst.resize(std::max(worst.size(), columns.size()));
        for (std::size_t k = 0; k < columns.size(); ++k)
            for (const double off : columns[k]) {
                EXPECT_LT(off, k_allowed) << shader.basis << " " << shader.part << ", " << k_columns[k];
                worst[k] = std::max(worst[k], off);
            }
    }
    for (const auto& [storage, worst] : worst_of) print_row(storage, worst);
}

}  // namespace
}  // namespace lobelia
