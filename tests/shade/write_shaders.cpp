// Writes the Metal code of every listed basis, evaluator and storage as one C++ source, for shader_parity_test.
//   write_shaders OUTPUT.cpp
// Each text stands in a namespace of its own; numbers become floats, as they are in Metal.
#include <fmt/format.h>

#include <fstream>
#include <iostream>
#include <regex>

#include "shade/shader.h"
#include "shader_cases.h"

namespace lobelia::shade {
namespace {

class Writer {
  public:
    /// Writes a text and a function `call`, and enters it in the table; nothing for a case without code.
    void add(const test::ShaderCase& shader) {
        const auto text = text_of(shader, Language::msl);
        if (!text) return;
        static const std::regex number(R"((\b[0-9]+\.[0-9]+(e[-+]?[0-9]+)?))");
        source_ += fmt::format("namespace case_{} {{\n{}\n{}}}\n\n", count_, std::regex_replace(*text, number, "$1f"),
                               unpacks(shader) ? unpacking(shader) : evaluation(shader, *text));
        table_ += fmt::format("    {{\"{}\", \"{}\", \"{}\", case_{}::call}},\n", shader.basis, shader.part,
                              shader.function, count_++);
    }

    [[nodiscard]] std::string result() const {
        return "// Written by write_shaders.\n#include \"shader_cases.h\"\n#include \"shader_types.h\"\n\n"
               "namespace lobelia::test {\nnamespace {\nusing namespace shader_types;\n\n" +
               source_ + "const ShaderCase k_cases[] = {\n" + table_ +
               "};\n}  // namespace\nstd::span<const ShaderCase> shader_cases() { return k_cases; }\n"
               "}  // namespace lobelia::test\n";
    }

  private:
    static std::string evaluation(const test::ShaderCase& shader, const std::string& text) {
        std::string before, arguments = "float3(d[0], d[1], d[2])";
        if (test::reflects(shader)) {
            before =
                "    GgxTexels texels;\n"
                "    const float3 n(d[0], d[1], d[2]), v(d[3], d[4], d[5]), f0(d[7], d[8], d[9]);\n";
            for (const auto& member : test::table_members(text))
                before += fmt::format(
                    "    const float2 at_{0} = ggx_coordinates({1}, d[6]);\n"
                    "    const auto value_{0} = sampled_table({2}, at_{0}.x, at_{0}.y);\n"
                    "    texels.{0} = float4(value_{0}[0], value_{0}[1], value_{0}[2], value_{0}[3]);\n",
                    member, test::is_of_normal(member) ? "1.0f" : "dot(n, v)", test::layer_of(member));
            arguments = "texels, n, v, d[6], f0";
        }
        return fmt::format(
            "void call(const float* c, const float* d, float* out) {{\n"
            "    Coefficients light;\n"
            "    for (int i = 0; i < {}; ++i) light.c[i] = float3(c[3 * i], c[3 * i + 1], c[3 * i + 2]);\n{}"
            "    const float3 value = {}(light, {});\n"
            "    for (int k = 0; k < 3; ++k) out[k] = value[k];\n}}\n",
            codec_of(shader).basis().size(), before, shader.function, arguments);
    }

    /// d holds the values of a Texel in their order.
    static std::string unpacking(const test::ShaderCase& shader) {
        const Codec codec = codec_of(shader);
        const TextureLayout layout = find_storage(shader.part).value()->layout(coefficient_traits(*codec.encoder()));
        std::string text = "void call(const float*, const float* d, float* out) {\n    Texel t;\n";
        for (const auto& texture : layout.textures) {
            text += fmt::format("    t.{} = float4(d[0], d[1], d[2], d[3]);\n    d += 4;\n", texture.name);
            if (decode_function(texture.format)) text += fmt::format("    t.{}_scale = *d++;\n", texture.name);
        }
        return text + fmt::format(
                          "    const Coefficients light = unpack(t);\n"
                          "    for (int i = 0; i < {}; ++i)\n"
                          "        for (int k = 0; k < 3; ++k) out[3 * i + k] = light.c[i][k];\n}}\n",
                          codec.basis().size());
    }

    std::string source_, table_;
    int count_ = 0;
};

}  // namespace
}  // namespace lobelia::shade

int main(int count, char** arguments) {
    using namespace lobelia;
    if (count != 2) return std::cerr << "write_shaders OUTPUT.cpp\n", 2;
    shade::Writer writer;
    for (const auto& name : basis_names()) {
        const auto basis = make_basis(name).value();
        const auto evaluators = basis->evaluator_names();
        for (const auto& evaluator : evaluators) writer.add({name.c_str(), evaluator.c_str(), "irradiance", nullptr});
        writer.add({name.c_str(), evaluators.front().c_str(), "radiance", nullptr});
        for (const auto& specular : basis->specular_names())
            writer.add({name.c_str(), specular.c_str(), "specular", nullptr});
        for (const Storage& storage : storages())
            if (!test::encoder_for(name, storage).empty())
                writer.add({name.c_str(), storage.name.data(), "unpack", nullptr});
    }
    // Lobes that no listed basis has: sharp ones, differing sharpness, an ambient one.
    writer.add({"sg3@300", "exact", "radiance", nullptr});
    constexpr const char* mixed = "sg{0 0 1 5;1 0 0 20;ambient;-0.6 0.8 0 0.5}";
    for (const char* evaluator : {"inner-product", "punctual", "hill", "tokuyoshi", "odd-exact-2", "exact"})
        writer.add({mixed, evaluator, "irradiance", nullptr});
    writer.add({mixed, "exact", "radiance", nullptr});
    for (const auto& specular : make_basis(mixed).value()->specular_names())
        writer.add({mixed, specular.c_str(), "specular", nullptr});
    std::ofstream file(arguments[1]);
    file << writer.result();
    return file.flush() ? 0 : 1;
}
