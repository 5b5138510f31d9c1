#include "shader_runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <sstream>

#include "glslang.h"

namespace lobelia::test {
namespace {

using shade::Language;

/// Invocations of a group; each evaluates one direction, or unpacks one texel.
constexpr std::size_t k_group = 64;
/// Cases in one shader: fewer starts of glslangValidator, but drivers look at the functions of all for each.
constexpr std::size_t k_batch = 4;

/// The declarations before the texts of a compute shader.
std::string compute_head(Language language) {
    if (language == Language::hlsl)
        return "[[vk::constant_id(0)]] const int chosen_case = 0;\n"
               "[[vk::constant_id(1)]] const int direction_count = 1;\n"
               "[[vk::binding(0, 0)]] StructuredBuffer<float> input_values;\n"
               "[[vk::binding(1, 0)]] StructuredBuffer<float> input_xyz;\n"
               "[[vk::binding(2, 0)]] RWStructuredBuffer<float> results;\n";
    return fmt::format(
        "#version 450\nlayout(local_size_x = {}) in;\n"
        "layout(constant_id = 0) const int chosen_case = 0;\n"
        "layout(constant_id = 1) const int direction_count = 1;\n"
        "layout(set = 0, binding = 0) readonly buffer Values {{ float input_values[]; }};\n"
        "layout(set = 0, binding = 1) readonly buffer Xyz {{ float input_xyz[]; }};\n"
        "layout(set = 0, binding = 2) writeonly buffer Results {{ float results[]; }};\n",
        k_group);
}

/// A function that samples the table of reflection lobes, which lies behind the points.
std::string table_sampling(const std::string& vec) {
    const SpecularTable table = ggx_table();
    return fmt::format(
        "{0}4 table_texel(int layer, int x, int y) {{\n"
        "    int at = {1} * direction_count + 4 * ((layer * {3} + y) * {2} + x);\n"
        "    return {0}4(input_xyz[at], input_xyz[at + 1], input_xyz[at + 2], input_xyz[at + 3]);\n}}\n"
        "{0}4 table_sample(int layer, {0}2 uv) {{\n"
        "    float u = clamp(uv.x * {2}.0 - 0.5, 0.0, {2}.0 - 1.0), v = clamp(uv.y * {3}.0 - 0.5, 0.0, {3}.0 - 1.0);\n"
        "    int x = min(int(u), {2} - 2), y = min(int(v), {3} - 2);\n"
        "    {0}4 a = table_texel(layer, x, y), b = table_texel(layer, x, y + 1);\n"
        "    a += (table_texel(layer, x + 1, y) - a) * (u - float(x));\n"
        "    b += (table_texel(layer, x + 1, y + 1) - b) * (u - float(x));\n"
        "    return a + (b - a) * (v - float(y));\n}}\n",
        vec, k_point_floats, table.width, table.height);
}

/// A function that evaluates coefficients `y` at point `x`.
std::string reflection(const ShaderCase& shader, const std::string& text, const std::string& vec) {
    std::string members;
    for (const auto& member : table_members(text))
        members += fmt::format("    texels.{} = table_sample({}, ggx_coordinates({}, alpha));\n", member,
                               layer_of(member), is_of_normal(member) ? "1.0" : "dot(n, v)");
    return table_sampling(vec) +
           fmt::format(
               "void run_case(int x, int y) {{\n"
               "    Coefficients light;\n"
               "    for (int i = 0; i < {1}; i++) {{\n"
               "        int at = 3 * ({1} * y + i);\n"
               "        light.c[i] = {0}3(input_values[at], input_values[at + 1], input_values[at + 2]);\n"
               "    }}\n"
               "    int p = {2} * x;\n"
               "    {0}3 n = {0}3(input_xyz[p], input_xyz[p + 1], input_xyz[p + 2]);\n"
               "    {0}3 v = {0}3(input_xyz[p + 3], input_xyz[p + 4], input_xyz[p + 5]);\n"
               "    float alpha = input_xyz[p + 6];\n"
               "    {0}3 f0 = {0}3(input_xyz[p + 7], input_xyz[p + 8], input_xyz[p + 9]);\n"
               "    GgxTexels texels;\n{3}"
               "    {0}3 value = specular(light, texels, n, v, alpha, f0);\n"
               "    int out_at = 3 * (direction_count * y + x);\n"
               "    results[out_at] = value.x;\n    results[out_at + 1] = value.y;\n    results[out_at + 2] = "
               "value.z;\n"
               "}}\n",
               vec, codec_of(shader).basis().size(), k_point_floats, members);
}

/// A function that evaluates coefficients `y` at direction `x`.
std::string evaluation(const ShaderCase& shader, std::string_view vec3) {
    return fmt::format(
        "void run_case(int x, int y) {{\n"
        "    Coefficients light;\n"
        "    for (int i = 0; i < {0}; i++) {{\n"
        "        int at = 3 * ({0} * y + i);\n"
        "        light.c[i] = {1}(input_values[at], input_values[at + 1], input_values[at + 2]);\n"
        "    }}\n"
        "    {1} value = {2}(light, {1}(input_xyz[3 * x], input_xyz[3 * x + 1], input_xyz[3 * x + 2]));\n"
        "    int out_at = 3 * (direction_count * y + x);\n"
        "    results[out_at] = value.x;\n    results[out_at + 1] = value.y;\n    results[out_at + 2] = value.z;\n}}\n",
        codec_of(shader).basis().size(), vec3, shader.function);
}

/// A function that unpacks texel `x`.
std::string unpacking(const ShaderCase& shader, std::string_view vec4) {
    const Codec codec = codec_of(shader);
    std::size_t stride = 0;
    std::string members;
    for (const auto& texture :
         find_storage(shader.part).value()->layout(coefficient_traits(*codec.encoder())).textures) {
        members += fmt::format(
            "    t.{0} = {1}(input_values[at + {2}], input_values[at + {3}], input_values[at + {4}], input_values[at + "
            "{5}]);\n",
            texture.name, vec4, stride, stride + 1, stride + 2, stride + 3);
        stride += 4;
        if (decode_function(texture.format))
            members += fmt::format("    t.{}_scale = input_values[at + {}];\n", texture.name, stride++);
    }
    return fmt::format(
        "void run_case(int x, int y) {{\n    int at = {0} * x;\n    Texel t;\n{1}"
        "    Coefficients light = unpack(t);\n"
        "    for (int i = 0; i < {2}; i++) {{\n"
        "        int out_at = 3 * ({2} * x + i);\n"
        "        results[out_at] = light.c[i].x;\n        results[out_at + 1] = light.c[i].y;\n"
        "        results[out_at + 2] = light.c[i].z;\n    }}\n}}\n",
        stride, members, codec.basis().size());
}

/// A whole compute shader: its constant 0 chooses one of the cases with a text, constant 1 is the number of directions.
std::string compute_shader(std::span<const ShaderCase> shaders, std::span<const std::string> texts, Language language) {
    const std::string vec3(info(language).vec3), vec = vec3.substr(0, vec3.size() - 1), vec4 = vec + "4";
    std::string text = compute_head(language), choices;
    for (std::size_t i = 0; i < shaders.size(); ++i) {
        if (texts[i].empty()) continue;
        const std::string suffix = fmt::format("_case_{}", i);
        text += with_own_names(texts[i] + (unpacks(shaders[i])    ? unpacking(shaders[i], vec4)
                                           : reflects(shaders[i]) ? reflection(shaders[i], texts[i], vec)
                                                                  : evaluation(shaders[i], vec3)),
                               suffix);
        choices += fmt::format("    if (chosen_case == {}) run_case{}(x, y);\n", i, suffix);
    }
    if (language == Language::hlsl)
        return text + fmt::format(
                          "[numthreads({}, 1, 1)]\nvoid main(uint3 id : SV_DispatchThreadID) {{\n"
                          "    int x = int(id.x), y = int(id.y);\n{}}}\n",
                          k_group, choices);
    return text + "void main() {\n    int x = int(gl_GlobalInvocationID.x), y = int(gl_GlobalInvocationID.y);\n" +
           choices + "}\n";
}

}  // namespace

std::string with_own_names(const std::string& text, const std::string& suffix) {
    // An outermost declaration begins a line: the name is the last word before what follows it.
    std::set<std::string> names;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (line.empty() || std::isalpha(static_cast<unsigned char>(line.front())) == 0) continue;
        const std::string start = line.substr(0, line.find_first_of("({[="));
        const std::size_t end = start.find_last_not_of(' ') + 1;
        names.insert(start.substr(start.find_last_of(' ', end - 1) + 1, end - start.find_last_of(' ', end - 1) - 1));
    }
    std::string before, after;
    for (const auto& name : names) {
        before += fmt::format("#define {0} {0}{1}\n", name, suffix);
        after += fmt::format("#undef {}\n", name);
    }
    return before + text + after;
}

bool runs_on_vulkan(const ShaderCase& shader) {
    return !unpacks(shader) || make_basis(shader.basis).value()->size() <= 36;
}

std::vector<float> run_msl_as_cpp(const ShaderCase& shader, const ShaderInput& input) {
    std::vector<float> results(input.texels * input.directions * input.results);
    for (std::size_t i = 0; i < input.texels; ++i)
        for (std::size_t j = 0; j < input.directions; ++j) {
            const float* texel = input.values.data() + i * input.stride();
            float* out = results.data() + (i * input.directions + j) * input.results;
            if (unpacks(shader))
                shader.call(nullptr, texel, out);
            else
                shader.call(texel, input.xyz.data() + (reflects(shader) ? k_point_floats : 3) * j, out);
        }
    return results;
}

Result<std::unique_ptr<VulkanRunner>> VulkanRunner::open(Language language) {
    if (!has_glslang()) return Error{"no glslangValidator: install glslang-tools"};
    auto compute = VulkanCompute::open();
    if (!compute) return compute.error();
    return std::unique_ptr<VulkanRunner>(new VulkanRunner(language, std::move(compute).value()));
}

Result<std::vector<float>> VulkanRunner::run(const ShaderCase& shader, const ShaderInput& input) {
    const auto all = shader_cases();
    const auto index = static_cast<std::size_t>(&shader - all.data());
    if (spirv_.empty() || index / k_batch != batch_) {
        batch_ = index / k_batch;
        const auto shaders = all.subspan(batch_ * k_batch, std::min(k_batch, all.size() - batch_ * k_batch));
        std::vector<std::string> texts;
        for (const ShaderCase& other : shaders)
            texts.push_back(runs_on_vulkan(other) ? text_of(other, language_).value() : "");
        auto spirv = spirv_of(compute_shader(shaders, texts, language_), language_);
        if (!spirv) return spirv.error();
        spirv_ = std::move(spirv).value();
    }
    return dispatch(input, spirv_, index % k_batch);
}

Result<std::vector<float>> VulkanRunner::run(const ShaderCase& shader, const std::string& text,
                                             const ShaderInput& input) {
    const auto spirv = spirv_of(compute_shader({&shader, 1}, {&text, 1}, language_), language_);
    if (!spirv) return spirv.error();
    return dispatch(input, *spirv, 0);
}

Result<std::vector<float>> VulkanRunner::dispatch(const ShaderInput& input, std::span<const std::uint32_t> spirv,
                                                  std::size_t chosen) {
    // Texels to unpack go side by side, others one below the other.
    const bool unpacking = input.xyz.empty();
    const std::size_t x = unpacking ? input.texels : input.directions, y = unpacking ? 1 : input.texels;
    check_range("invocations beyond whole groups", x % k_group, 0, 0);
    ComputeJob job;
    job.spirv = spirv;
    job.constants = {static_cast<std::int32_t>(chosen), static_cast<std::int32_t>(input.directions)};
    job.first = input.values;
    job.second = input.xyz;
    job.results = input.texels * input.directions * input.results;
    job.groups = {static_cast<std::uint32_t>(x / k_group), static_cast<std::uint32_t>(y)};
    return compute_->run(job);
}

}  // namespace lobelia::test
