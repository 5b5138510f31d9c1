// ShaderParity through real textures: the bytes of every storage as images of a Vulkan driver, filtered by its hardware
// between texels, unpacked and evaluated by the shader code, against the library's TextureSampler.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "glslang.h"
#include "lobelia/environment.h"
#include "lobelia/evaluate.h"
#include "lobelia/sky.h"
#include "lobelia/storage.h"
#include "shade/shader.h"
#include "support.h"
#include "vulkan_compute.h"

namespace lobelia {
namespace {

constexpr std::size_t k_side = 16, k_points = 4096, k_group = 64;
constexpr std::array k_codecs = {"sh1/moments/convolution", "sh1/moments/geomerics", "sh2/moments/convolution",
                                 "sg12/nnls/odd-exact-2",   "ahd/moments/punctual",  "irradz/moments/linear"};

/// Planes of a page whose texels are encoded from a few samples of the sky each, so that neighbours differ.
std::vector<std::vector<float>> page_of(const Encoder& encoder) {
    const Image environment = sky({64, 32});
    const std::size_t count = encoder.basis().size();
    std::vector<std::vector<float>> planes(3 * count, std::vector<float>(k_side * k_side));
    for (std::size_t i = 0; i < k_side * k_side; ++i) {
        const auto directions = test::random_directions(encoder.basis().domain(), 64, static_cast<std::uint32_t>(i));
        Accumulator accumulator{std::shared_ptr<const Encoder>(std::shared_ptr<void>(), &encoder)};
        accumulator.add(directed_samples(environment, directions, encoder.basis().domain()));
        const auto c = accumulator.solve();
        for (std::size_t p = 0; p < planes.size(); ++p) planes[p][i] = (&c[0].r)[p];
    }
    return planes;
}

/// Where textures are read, between texels too, and the normals there.
struct Points {
    explicit Points(Domain domain) : normals(test::random_directions(domain, k_points, 11)) {
        std::mt19937 generator(12);
        std::uniform_real_distribution<float> uniform(0, 1);
        for (std::size_t i = 0; i < k_points; ++i) uv.push_back({uniform(generator), uniform(generator)});
    }
    Directions normals;
    std::vector<Vec2> uv;
};

/// A compute shader that reads the textures at each point: `values` holds u, v and the normal. Formats that only the
/// shader decodes are read texel by texel, and filtered after unpacking.
std::string shader_of(const Codec& codec, const TextureLayout& layout, const std::string& functions,
                      std::span<const PackedTexture> packed) {
    std::string members, unfiltered;
    for (std::size_t t = 0; t < packed.size(); ++t) {
        const std::string& name = layout.textures[t].name;
        const bool decoded = decode_function(layout.textures[t].format) != nullptr;
        const std::string scale =
            fmt::format("{:.9g}", packed[t].scale) +
            (fmt::format("{:.9g}", packed[t].scale).find_first_of(".e") == std::string::npos ? ".0" : "");
        members += fmt::format("    t.{0} = {2} * texture(textures[{1}], uv);\n", name, t, scale);
        unfiltered += decoded ? fmt::format("    t.{0} = texelFetch(textures[{1}], at, 0);\n    t.{0}_scale = {2};\n",
                                            name, t, scale)
                              : "";
    }
    const std::string sample =
        unfiltered.empty()
            ? fmt::format("Coefficients light_at(vec2 uv) {{\n    Texel t;\n{}    return unpack(t);\n}}\n", members)
            : fmt::format(
                  "Coefficients light_of(ivec2 at) {{\n    at = clamp(at, ivec2(0), ivec2({0} - 1));\n    Texel t;\n{1}"
                  "    return unpack(t);\n}}\n"
                  "Coefficients light_at(vec2 uv) {{\n"
                  "    vec2 place = uv * {0}.0 - 0.5;\n    ivec2 at = ivec2(floor(place));\n    vec2 f = place - "
                  "floor(place);\n"
                  "    Coefficients a = light_of(at), b = light_of(at + ivec2(1, 0));\n"
                  "    Coefficients c = light_of(at + ivec2(0, 1)), d = light_of(at + ivec2(1, 1));\n"
                  "    for (int i = 0; i < {2}; i++)\n"
                  "        a.c[i] = mix(mix(a.c[i], b.c[i], f.x), mix(c.c[i], d.c[i], f.x), f.y);\n"
                  "    return a;\n}}\n",
                  k_side, unfiltered, codec.basis().size());
    return fmt::format(
               "#version 450\nlayout(local_size_x = {}) in;\n"
               "layout(set = 0, binding = 0) readonly buffer Values {{ float values[]; }};\n"
               "layout(set = 0, binding = 2) writeonly buffer Results {{ float results[]; }};\n"
               "layout(set = 0, binding = 3) uniform sampler2D textures[{}];\n",
               k_group, test::k_most_textures) +
           functions + sample +
           "void main() {\n    int i = int(gl_GlobalInvocationID.x), at = 5 * i;\n"
           "    vec3 n = vec3(values[at + 2], values[at + 3], values[at + 4]);\n"
           "    vec3 e = irradiance(light_at(vec2(values[at], values[at + 1])), n);\n"
           "    results[3 * i] = e.x;\n    results[3 * i + 1] = e.y;\n    results[3 * i + 2] = e.z;\n}\n";
}

/// The lowest and the highest value that filtering may give: hardware knows a place between texels to 1/256.
struct Range {
    Rgb low, high;
    void add(Rgb e) {
        low = {std::min(low.r, e.r), std::min(low.g, e.g), std::min(low.b, e.b)};
        high = {std::max(high.r, e.r), std::max(high.g, e.g), std::max(high.b, e.b)};
    }
};
Range range_at(const Evaluator& evaluator, const TextureSampler& sampler, Vec2 uv, Vec3 normal) {
    constexpr float k_step = 1.0f / 256 / k_side;
    const Rgb e = irradiance(evaluator, sampler, uv, normal);
    Range range{e, e};
    for (const float x : {-k_step, 0.0f, k_step})
        for (const float y : {-k_step, 0.0f, k_step})
            range.add(irradiance(evaluator, sampler, {uv.x + x, uv.y + y}, normal));
    return range;
}

/// The most by which the storage's stated bound on coefficients can change E anywhere, relative to the largest E: sums
/// the changes of one coefficient at a time.
double stated_bound(const Codec& codec, const Storage& storage, const std::vector<std::vector<float>>& planes,
                    const Points& points, double largest) {
    const auto traits = coefficient_traits(*codec.encoder());
    auto allowed = planes;
    allowed_error(storage, traits, {k_side, k_side, std::span(planes), traits.count},
                  MutableCoefficientPlanes(k_side, k_side, std::span(allowed), traits.count));
    double worst = 0;
    Directions normals(16);
    for (std::size_t j = 0; j < normals.size(); ++j) set_entry(normals.view(), j, direction_at(points.normals, j));
    for (std::size_t i = 0; i < k_side * k_side; i += 5) {
        std::vector<Rgb> c(traits.count);
        for (std::size_t p = 0; p < planes.size(); ++p) (&c[0].r)[p] = planes[p][i];
        Colours e(normals.size()), changed(normals.size());
        codec.irradiance(c, normals, e);
        std::vector<double> sum(3 * normals.size());
        for (std::size_t k = 0; k < traits.count; ++k) {
            auto moved = c;
            moved[k] = moved[k] + Rgb{allowed[3 * k][i], allowed[3 * k + 1][i], allowed[3 * k + 2][i]};
            codec.irradiance(moved, normals, changed);
            for (std::size_t channel = 0; channel < 3; ++channel)
                for (std::size_t j = 0; j < normals.size(); ++j)
                    sum[3 * j + channel] +=
                        std::abs(static_cast<double>(changed.channel(channel)[j]) - e.channel(channel)[j]);
        }
        for (const double s : sum) worst = std::max(worst, s / largest);
    }
    return worst;
}

struct Difference {
    double beyond_filtering = 0;  ///< of the range of filtering, relative to the largest E
    double plain = 0;             ///< of exact filtering
};

Result<Difference> difference(test::VulkanCompute& vulkan, const Codec& codec, const Storage& storage,
                              const std::vector<std::vector<float>>& planes, const Points& points, double& largest) {
    const TextureLayout layout = storage.layout(coefficient_traits(*codec.encoder()));
    const auto packed = pack(layout, CoefficientPlanes(k_side, k_side, std::span(planes), layout.coefficients));
    const auto functions =
        shade::shader_text(codec, {shade::Language::glsl, {shade::Need::irradiance}, &storage, std::nullopt});
    if (!functions) return functions.error();
    const auto spirv = test::spirv_of(shader_of(codec, layout, *functions, packed), shade::Language::glsl);
    if (!spirv) return spirv.error();

    std::vector<float> values;
    for (std::size_t i = 0; i < k_points; ++i) {
        const Vec3 n = direction_at(points.normals, i);
        values.insert(values.end(), {points.uv[i].x, points.uv[i].y, n.x, n.y, n.z});
    }
    std::vector<test::ComputeTexture> textures;
    for (const PackedTexture& texture : packed)
        textures.push_back({info(texture.format).vk_format, static_cast<std::uint32_t>(texture.width),
                            static_cast<std::uint32_t>(texture.height), texture.data});
    test::ComputeJob job;
    job.spirv = *spirv;
    job.first = values;
    job.results = 3 * k_points;
    job.groups = {k_points / k_group, 1};
    job.textures = textures;
    const auto found = vulkan.run(job);
    if (!found) return found.error();

    const auto sampler = TextureSampler::make(layout, packed);
    if (!sampler) return sampler.error();
    std::vector<Range> ranges;
    std::vector<Rgb> exact;
    largest = 0;
    for (std::size_t i = 0; i < k_points; ++i) {
        const Vec3 n = direction_at(points.normals, i);
        ranges.push_back(range_at(codec.evaluator(), *sampler, points.uv[i], n));
        exact.push_back(irradiance(codec.evaluator(), *sampler, points.uv[i], n));
        for (std::size_t k = 0; k < 3; ++k) largest = std::max<double>(largest, (&exact[i].r)[k]);
    }
    Difference result;
    for (std::size_t i = 0; i < k_points; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const double e = (*found)[3 * i + k], low = (&ranges[i].low.r)[k], high = (&ranges[i].high.r)[k];
            const double off = std::max({low - e, e - high, 0.0}) / largest;
            result.beyond_filtering = std::isnan(e) ? HUGE_VAL : std::max(result.beyond_filtering, off);
            result.plain = std::max(result.plain, std::abs(e - static_cast<double>((&exact[i].r)[k])) / largest);
        }
    return result;
}

/// Whether a texture has channels of 8 bits that hardware filters.
bool has_bytes(const TextureLayout& layout) {
    return std::any_of(layout.textures.begin(), layout.textures.end(), [](const TextureLayout::Texture& texture) {
        return texture.format == PixelFormat::r8 || texture.format == PixelFormat::rg8 ||
               texture.format == PixelFormat::rgba8;
    });
}

TEST(TextureParity, HardwareFiltersWhatTheLibraryFilters) {
    auto vulkan = test::VulkanCompute::open();
    if (!vulkan) GTEST_SKIP() << "textures are not sampled here: " << vulkan.error().message;
    if (!test::has_glslang()) GTEST_SKIP() << "textures are not sampled here: no glslangValidator";
    std::printf("%s\n%-44s %10s %10s %10s\n", (*vulkan)->device().c_str(), "largest difference, of the largest E",
                "of exact", "filtering", "stated");
    for (const char* name : k_codecs) {
        const Codec codec = make_codec(name).value();
        const auto planes = page_of(*codec.encoder());
        const Points points(codec.basis().domain());
        const auto traits = coefficient_traits(*codec.encoder());
        for (const Storage& storage : storages()) {
            if (!suits(storage, traits) || storage.layout(traits).textures.size() > test::k_most_textures) continue;
            double largest = 0;
            const auto off = difference(**vulkan, codec, storage, planes, points, largest);
            ASSERT_TRUE(off) << name << " " << storage.name << ": " << off.error().message;
            const double stated = stated_bound(codec, storage, planes, points, largest);
            std::printf("%-44s %10.1e %10.1e %10.1e\n", fmt::format("{} {}", name, storage.name).c_str(), off->plain,
                        off->beyond_filtering, stated);
            // Drivers may filter bytes in bytes, which changes E no more than storing bytes does.
            EXPECT_LE(off->beyond_filtering, has_bytes(storage.layout(traits)) ? std::min(stated, 0.01) : 2e-5)
                << name << " " << storage.name;
        }
    }
}

}  // namespace
}  // namespace lobelia
