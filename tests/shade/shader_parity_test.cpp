// ShaderParity: the shader code of every basis, evaluator and storage gives what the library gives. The Metal text is
// compiled as C++ (write_shaders.cpp); the other languages are translated from the same source, word by word.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "lobelia/codec.h"
#include "lobelia/environment.h"
#include "lobelia/sky.h"
#include "lobelia/storage.h"
#include "shade/shader.h"
#include "shader_cases.h"
#include "support.h"

namespace lobelia {
namespace {

constexpr std::size_t k_texels = 64, k_normals = 4096;
/// Difference from the library relative to the largest channel of a texel.
constexpr double k_allowed = 2e-5;

/// The same for a texel: float32 knows the exponent of a sharp lobe, s (cosine - 1), only to 1.2e-7 of the sharpness s.
double allowed_for(const Basis& basis, const std::vector<Rgb>& c) {
    double sharpest = 0;
    const auto meanings = basis.meanings();
    for (std::size_t i = 0; i < c.size(); ++i)
        if (meanings[i] == Meaning::shape)
            sharpest = std::max(sharpest, std::hypot(static_cast<double>(c[i].r), c[i].g, c[i].b));
    return k_allowed + 1.2e-7 * sharpest;
}

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

std::shared_ptr<const Encoder> encoder_of(const std::string& basis) {
    const auto made = make_basis(basis).value();
    return make_encoder(encoder_names(*made).front(), made).value();
}

double largest_of(const Colours& colours) {
    double largest = 1e-30;
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t j = 0; j < colours.size(); ++j)
            largest = std::max(largest, std::abs(static_cast<double>(colours.channel(k)[j])));
    return largest;
}

double difference(const test::ShaderCase& shader, const std::vector<Rgb>& c, DirectionView directions,
                  const Colours& expected) {
    double worst = 0;
    const double largest = largest_of(expected);
    for (std::size_t j = 0; j < directions.size; ++j) {
        const Vec3 d = direction_at(directions, j);
        float out[3];
        shader.call(&c[0].r, &d.x, out);
        for (std::size_t k = 0; k < 3; ++k) {
            const double off = std::abs(static_cast<double>(out[k]) - expected.channel(k)[j]) / largest;
            worst = off <= worst ? worst : off;  // a NaN becomes the worst
        }
    }
    return worst;
}

TEST(ShaderParity, FunctionsGiveWhatTheLibraryGives) {
    std::map<std::string, std::vector<std::vector<Rgb>>> texels;
    for (const test::ShaderCase& shader : test::shader_cases()) {
        if (std::string_view(shader.function) == "unpack") continue;
        const std::string basis = shader.basis;
        const auto encoder = encoder_of(basis);
        // Large maps of texels take long to sum up.
        const bool large = encoder->basis().size() > 100;
        if (!texels.contains(basis)) texels[basis] = texels_of(*encoder, large ? 4 : k_texels);
        const Codec codec =
            make_codec(basis + "/" + encoder_names(encoder->basis()).front() + "/" + shader.part).value();
        const Directions directions = test::random_directions(encoder->basis().domain(), large ? 256 : k_normals, 9);
        double worst = 0;
        for (const auto& c : texels[basis]) {
            Colours expected(directions.size());
            if (std::string_view(shader.function) == "irradiance")
                codec.irradiance(c, directions, expected);
            else
                codec.radiance(c, directions, expected);
            const double off = difference(shader, c, directions, expected);
            worst = off <= worst ? worst : off;
            EXPECT_LT(off, allowed_for(encoder->basis(), c)) << basis << " " << shader.part << " " << shader.function;
        }
        std::printf("%-16s %-20s %-10s %.1e\n", shader.basis, shader.part, shader.function, worst);
    }
}

/// Values of a texture as graphics interfaces give them at one texel, four a texel, and the scale where the code asks
/// for it.
void append_sampled(std::vector<float>& texel, const TextureLayout::Texture& layout, const PackedTexture& packed,
                    std::size_t place) {
    const FormatInfo& format = info(layout.format);
    float values[4] = {0, 0, 0, 1};
    if (decode_function(layout.format)) {
        for (std::size_t k = 0; k < 4; ++k)
            values[k] = static_cast<float>(std::to_integer<int>(packed.data[4 * place + k])) / 255;
        texel.insert(texel.end(), values, values + 4);
        texel.push_back(packed.scale);
        return;
    }
    std::vector<std::vector<float>> channels(format.channels, std::vector<float>(packed.width * packed.height));
    std::vector<float*> pointers;
    for (auto& channel : channels) pointers.push_back(channel.data());
    decode_texels(layout.format, packed.width, packed.height, packed.data, pointers);
    for (std::size_t k = 0; k < format.channels; ++k) values[k] = channels[k][place] * packed.scale;
    texel.insert(texel.end(), values, values + 4);
}

TEST(ShaderParity, UnpackingGivesWhatTheLibraryUnpacks) {
    constexpr std::size_t side = 8;
    std::map<std::string_view, double> worst_of;
    for (const test::ShaderCase& shader : test::shader_cases()) {
        if (std::string_view(shader.function) != "unpack") continue;
        SCOPED_TRACE(std::string(shader.basis) + " " + shader.part);
        const Storage& storage = *find_storage(shader.part).value();
        const auto encoder =
            make_encoder(test::encoder_for(shader.basis, storage), make_basis(shader.basis).value()).value();
        const std::size_t planes = 3 * encoder->basis().size();
        const auto texels = texels_of(*encoder, planes > 300 ? 4 : side * side);
        const TextureLayout layout = storage.layout(coefficient_traits(*encoder));

        // Pack a page and unpack it again.
        std::vector<std::vector<float>> page(planes, std::vector<float>(side * side)), expected = page;
        for (std::size_t p = 0; p < planes; ++p)
            for (std::size_t i = 0; i < side * side; ++i) page[p][i] = (&texels[i % texels.size()][0].r)[p];
        const auto packed = pack(layout, CoefficientPlanes(side, side, std::span(page), planes / 3));
        unpack(layout, packed, MutableCoefficientPlanes(side, side, std::span(expected), planes / 3));

        for (const std::size_t i : {0u, 9u, 27u, 63u}) {
            std::vector<float> texel, out(planes);
            for (std::size_t t = 0; t < packed.size(); ++t) {
                const std::size_t step = layout.textures[t].subsampling, x = i % side / step, y = i / side / step;
                append_sampled(texel, layout.textures[t], packed[t], y * packed[t].width + x);
            }
            shader.call(nullptr, texel.data(), out.data());
            double largest = 1e-30, off = 0;
            for (std::size_t p = 0; p < planes; ++p) {
                largest = std::max(largest, std::abs(static_cast<double>(expected[p][i])));
                const double error = std::abs(static_cast<double>(out[p]) - expected[p][i]);
                off = error <= off ? off : error;
            }
            EXPECT_LT(off / largest, k_allowed);
            worst_of[shader.part] = std::max(worst_of[shader.part], off / largest);
        }
    }
    for (const auto& [storage, worst] : worst_of) std::printf("%-16s %.1e\n", std::string(storage).c_str(), worst);
}

TEST(ShaderParity, AWrongSignIsFound) {
    // The difference of a texel and the same with the sign of one coefficient turned, by the same code.
    for (const test::ShaderCase& shader : test::shader_cases()) {
        if (std::string_view(shader.function) != "irradiance" || std::string_view(shader.basis) != "sh1") continue;
        const auto encoder = encoder_of(shader.basis);
        auto c = texels_of(*encoder, 1).front();
        const Codec codec = make_codec(std::string("sh1/moments/") + shader.part).value();
        const Directions directions = test::random_directions(Domain::sphere, 256, 9);
        Colours expected(directions.size());
        codec.irradiance(c, directions, expected);
        c[1] = c[1] * -1.0f;
        EXPECT_GT(difference(shader, c, directions, expected), 1e-2) << shader.part;
    }
}

TEST(ShaderParity, EveryCodecHasCodeOrAReason) {
    for (const auto& name : basis_names())
        for (const auto& evaluator : make_basis(name).value()->evaluator_names()) {
            const Codec codec =
                make_codec(name + "/" + encoder_names(*make_basis(name).value()).front() + "/" + evaluator).value();
            for (const auto& language : shade::languages())
                for (const shade::Need need : {shade::Need::irradiance, shade::Need::radiance}) {
                    const auto text = shade::shader_text(codec, {language.language, {need}, nullptr, std::nullopt});
                    if (text)
                        EXPECT_EQ(text->find("has no shader code"), std::string::npos);
                    else
                        EXPECT_TRUE(evaluator == "dering" || (evaluator == "exact" && name.starts_with("sgfit")))
                            << text.error().message;
                }
        }
}

}  // namespace
}  // namespace lobelia
