// ShaderParity of probes: the weights that the shader code gives a probe are the library's, on a Vulkan driver.
#include <gtest/gtest.h>

#include <random>

#include "core/math/octahedral_map.h"
#include "glslang.h"
#include "lobelia/probe_volume.h"
#include "shade/shader.h"
#include "vulkan_compute.h"

namespace lobelia {
namespace {

TEST(ProbeShader, WeightsAreTheLibrarys) {
    auto vulkan = test::VulkanCompute::open();
    if (!vulkan) GTEST_SKIP() << "GLSL is not run here: " << vulkan.error().message;
    if (!test::has_glslang()) GTEST_SKIP() << "GLSL is not run here: no glslangValidator";
    constexpr std::size_t k_cases = 4096, k_inputs = 13;
    const auto text = shade::shader_text(make_codec("sh2/moments/convolution").value(),
                                         {shade::Language::glsl, {shade::Need::probes}, nullptr, std::nullopt});
    ASSERT_TRUE(text) << text.error().message;
    const auto spirv = test::spirv_of(
        "#version 450\nlayout(local_size_x = 64) in;\n"
        "layout(set = 0, binding = 0) readonly buffer Values { float v[]; };\n"
        "layout(set = 0, binding = 2) writeonly buffer Results { float results[]; };\n" +
            *text +
            "void main() {\n    int i = int(gl_GlobalInvocationID.x), a = 13 * i;\n"
            "    vec3 from = vec3(v[a + 7], v[a + 8], v[a + 9]);\n"
            "    results[3 * i] = probe_weight(v[a], vec3(v[a + 1], v[a + 2], v[a + 3]), vec3(v[a + 4], v[a + 5], v[a "
            "+ 6]), from, vec2(v[a + 10], v[a + 11]), v[a + 12]);\n"
            "    vec2 place = probe_map_place(normalize(from));\n"
            "    results[3 * i + 1] = place.x;\n    results[3 * i + 2] = place.y;\n}\n",
        shade::Language::glsl);
    ASSERT_TRUE(spirv) << spirv.error().message;

    std::mt19937 generator(3);
    std::uniform_real_distribution<float> uniform(0, 1);
    std::normal_distribution<float> normal(0, 1);
    const auto direction = [&] { return normalize(Vec3{normal(generator), normal(generator), normal(generator)}); };
    std::vector<float> values;
    std::vector<float> expected;
    for (std::size_t i = 0; i < k_cases; ++i) {
        const Vec3 n = direction(), from = direction() * (2 * uniform(generator)), to = from * -1 + n * 0.1f;
        const float mean = 2 * uniform(generator), square = mean * mean + 0.1f * uniform(generator);
        const ProbeAt at{uniform(generator), to, from, std::array{mean, square}, uniform(generator)};
        for (const float x :
             {at.trilinear, to.x, to.y, to.z, n.x, n.y, n.z, from.x, from.y, from.z, mean, square, at.validity})
            values.push_back(x);
        const auto place = OctahedralMap::place(normalize(from));
        expected.insert(expected.end(), {probe_weight(at, n), 0.5f + 0.5f * place[0], 0.5f + 0.5f * place[1]});
    }
    ASSERT_EQ(values.size(), k_inputs * k_cases);
    test::ComputeJob job;
    job.spirv = *spirv;
    job.first = values;
    job.results = 3 * k_cases;
    job.groups = {k_cases / 64, 1};
    const auto found = (*vulkan)->run(job);
    ASSERT_TRUE(found) << found.error().message;
    float worst = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) worst = std::max(worst, std::abs((*found)[i] - expected[i]));
    std::printf("probes: largest difference %.1e\n", static_cast<double>(worst));
    EXPECT_LT(worst, 2e-5f);
}

TEST(ProbeShader, HemispheresHaveNone) {
    const auto text = shade::shader_text(make_codec("irradz/moments/linear").value(),
                                         {shade::Language::glsl, {shade::Need::probes}, nullptr, std::nullopt});
    ASSERT_FALSE(text);
    EXPECT_NE(text.error().message.find("probes need the sphere"), std::string::npos);
}

}  // namespace
}  // namespace lobelia
