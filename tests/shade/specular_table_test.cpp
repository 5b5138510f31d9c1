// Specular shader code with the texture that bakes and lobelia shader --table write: a Vulkan driver filters its half
// floats, and the reflected light is the library's within the errors of the table.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "bake/write/ggx_table_file.h"
#include "folders.h"
#include "glossy_points.h"
#include "glslang.h"
#include "vulkan_compute.h"

namespace lobelia {
namespace {

constexpr std::size_t k_points = 4096, k_group = 64;

/// The bytes of the only level of a KTX2 file.
std::vector<std::byte> level_of(const std::string& file) {
    std::uint64_t offset = 0, size = 0;
    std::memcpy(&offset, file.data() + 80, sizeof offset);
    std::memcpy(&size, file.data() + 88, sizeof size);
    std::vector<std::byte> bytes(size);
    std::memcpy(bytes.data(), file.data() + offset, size);
    return bytes;
}

std::string shader_of(const test::ShaderCase& shader, std::size_t coefficients, std::size_t first_value) {
    const std::string text = test::text_of(shader, shade::Language::glsl).value();
    std::string members;
    for (const auto& member : test::table_members(text))
        members += fmt::format("    texels.{} = texture(layers[{}], ggx_coordinates({}, alpha));\n", member,
                               test::layer_of(member), test::is_of_normal(member) ? "1.0" : "dot(n, v)");
    return fmt::format(
        "#version 450\nlayout(local_size_x = {0}) in;\n"
        "layout(set = 0, binding = 0) readonly buffer Values {{ float values[]; }};\n"
        "layout(set = 0, binding = 2) writeonly buffer Results {{ float results[]; }};\n"
        "layout(set = 0, binding = 3) uniform sampler2D layers[{1}];\n{2}"
        "void main() {{\n    int i = int(gl_GlobalInvocationID.x), at = {3} * i;\n"
        "    Coefficients light;\n"
        "    for (int k = 0; k < {4}; k++)\n"
        "        light.c[k] = vec3(values[{5} + 3 * k], values[{5} + 3 * k + 1], values[{5} + 3 * k + 2]);\n"
        "    vec3 n = vec3(values[at], values[at + 1], values[at + 2]);\n"
        "    vec3 v = vec3(values[at + 3], values[at + 4], values[at + 5]);\n"
        "    float alpha = values[at + 6];\n    GgxTexels texels;\n{6}"
        "    vec3 e = specular(light, texels, n, v, alpha, vec3(values[at + 7], values[at + 8], values[at + 9]));\n"
        "    results[3 * i] = e.x;\n    results[3 * i + 1] = e.y;\n    results[3 * i + 2] = e.z;\n}}\n",
        k_group, test::k_most_textures, text, test::k_point_floats, coefficients, first_value, members);
}

TEST(SpecularTable, TheTextureGivesWhatTheLibraryReflects) {
    const test::TestFolder folder("specular-table");
    auto file = stage_ggx_table(folder.path() / "ggx-lobe.ktx2");
    ASSERT_TRUE(file) << file.error().message;
    ASSERT_TRUE(file->commit());
    EXPECT_FALSE(stage_ggx_table(folder.path() / "ggx-lobe.png"));
    auto vulkan = test::VulkanCompute::open();
    if (!vulkan) GTEST_SKIP() << "textures are not sampled here: " << vulkan.error().message;
    if (!test::has_glslang()) GTEST_SKIP() << "textures are not sampled here: no glslangValidator";

    const auto level = level_of(test::contents(folder.path() / "ggx-lobe.ktx2"));
    const SpecularTable table = ggx_table();
    const std::size_t layer_bytes = level.size() / table.layers;
    std::vector<test::ComputeTexture> layers;
    for (std::size_t i = 0; i < table.layers; ++i)
        layers.push_back({info(PixelFormat::rgba16f).vk_format, static_cast<std::uint32_t>(table.width),
                          static_cast<std::uint32_t>(table.height),
                          std::span(level).subspan(i * layer_bytes, layer_bytes)});

    const test::GlossyPoints points(Domain::sphere, k_points);
    for (const test::ShaderCase& shader : {test::ShaderCase{"sg12", "two-ends", "specular", nullptr},
                                           {"sg12", "moments", "specular", nullptr},
                                           {"sh8", "sh-convolution", "specular", nullptr},
                                           {"sh8", "sh-prefiltered", "specular", nullptr},
                                           {"sh1", "sh-dominant", "specular", nullptr}}) {
        const auto basis = make_basis(shader.basis).value();
        std::vector<Rgb> c;
        for (std::size_t i = 0; i < basis->size(); ++i) {
            const auto k = static_cast<float>(i);
            c.push_back(Rgb{1 + std::sin(k), 1 + std::cos(2 * k), 1 + std::sin(3 * k)} * (i == 0 ? 3.0f : 0.3f));
        }
        std::vector<float> values = points.floats();
        values.resize(k_points * test::k_point_floats);
        const std::size_t first_value = values.size();
        values.insert(values.end(), &c[0].r, &c[0].r + 3 * c.size());
        const auto spirv = test::spirv_of(shader_of(shader, c.size(), first_value), shade::Language::glsl);
        ASSERT_TRUE(spirv) << spirv.error().message;
        test::ComputeJob job;
        job.spirv = *spirv;
        job.first = values;
        job.results = 3 * k_points;
        job.groups = {k_points / k_group, 1};
        job.textures = layers;
        const auto found = (*vulkan)->run(job);
        ASSERT_TRUE(found) << found.error().message;

        Colours expected(k_points);
        specular(*make_specular(shader.part, basis).value(), c, points.points(), points.f0, expected);
        double largest = 0, off = 0;
        for (std::size_t i = 0; i < k_points; ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                const double value = expected.channel(k)[i], error = std::abs((*found)[3 * i + k] - value);
                largest = std::max(largest, std::abs(value));
                off = error <= off ? off : std::isnan(error) ? HUGE_VAL : error;
            }
        std::printf("%-24s %8.1e\n", fmt::format("{} {}", shader.basis, shader.part).c_str(), off / largest);
        EXPECT_LT(off / largest, 1e-3) << shader.basis << " " << shader.part;
    }
}

}  // namespace
}  // namespace lobelia
