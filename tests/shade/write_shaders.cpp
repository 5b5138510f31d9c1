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

/// The codec of an evaluator with any encoder: the functions do not depend on that.
Codec codec_of(const std::string& basis, const std::string& evaluator) {
    const std::string encoder = encoder_names(*make_basis(basis).value()).front();
    return make_codec(basis + "/" + encoder + "/" + evaluator).value();
}

class Writer {
  public:
    /// Writes a text and a function `call(c, d, out)`, and enters it in the table; nothing for what has no code.
    void function(const std::string& basis, const std::string& evaluator, Need need) {
        const Codec codec = codec_of(basis, evaluator);
        const auto text = shader_text(codec, {Language::msl, {need}, nullptr, std::nullopt});
        if (!text) return;
        const char* name = need == Need::irradiance ? "irradiance" : "radiance";
        open(*text);
        source_ += fmt::format(
            "void call(const float* c, const float* d, float* out) {{\n"
            "    Coefficients light;\n"
            "    for (int i = 0; i < {}; ++i) light.c[i] = float3(c[3 * i], c[3 * i + 1], c[3 * i + 2]);\n"
            "    const float3 value = {}(light, float3(d[0], d[1], d[2]));\n"
            "    for (int k = 0; k < 3; ++k) out[k] = value[k];\n}}\n",
            codec.basis().size(), name);
        close(fmt::format("{{\"{}\", \"{}\", \"{}\", case_{}::call}}", basis, evaluator, name, count_));
    }

    /// The same for unpacking: d holds the values of a Texel in their order.
    void unpacking(const std::string& basis, const Storage& storage) {
        const std::string encoder = test::encoder_for(basis, storage);
        if (encoder.empty()) return;
        const std::string evaluator = make_basis(basis).value()->evaluator_names().front();
        const Codec codec = make_codec(basis + "/" + encoder + "/" + evaluator).value();
        const auto text = shader_text(codec, {Language::msl, {}, &storage, std::nullopt});
        if (!text) return;
        open(*text);
        source_ += "void call(const float*, const float* d, float* out) {\n    Texel t;\n";
        for (const auto& texture : storage.layout(coefficient_traits(*codec.encoder())).textures) {
            source_ += fmt::format("    t.{} = float4(d[0], d[1], d[2], d[3]);\n    d += 4;\n", texture.name);
            if (decode_function(texture.format)) source_ += fmt::format("    t.{}_scale = *d++;\n", texture.name);
        }
        source_ += fmt::format(
            "    const Coefficients light = unpack(t);\n"
            "    for (int i = 0; i < {}; ++i)\n"
            "        for (int k = 0; k < 3; ++k) out[3 * i + k] = light.c[i][k];\n}}\n",
            codec.basis().size());
        close(fmt::format("{{\"{}\", \"{}\", \"unpack\", case_{}::call}}", basis, storage.name, count_));
    }

    [[nodiscard]] std::string result() const {
        return "// Written by write_shaders.\n#include \"shader_cases.h\"\n#include \"shader_types.h\"\n\n"
               "namespace lobelia::test {\nnamespace {\nusing namespace shader_types;\n\n" +
               source_ + "const ShaderCase k_cases[] = {\n" + table_ +
               "};\n}  // namespace\nstd::span<const ShaderCase> shader_cases() { return k_cases; }\n"
               "}  // namespace lobelia::test\n";
    }

  private:
    void open(const std::string& text) {
        static const std::regex number(R"((\b[0-9]+\.[0-9]+(e[-+]?[0-9]+)?))");
        source_ += fmt::format("namespace case_{} {{\n{}\n", count_, std::regex_replace(text, number, "$1f"));
    }
    void close(const std::string& entry) {
        source_ += "}\n\n";
        table_ += "    " + entry + ",\n";
        ++count_;
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
        for (const auto& evaluator : basis->evaluator_names())
            writer.function(name, evaluator, shade::Need::irradiance);
        writer.function(name, basis->evaluator_names().front(), shade::Need::radiance);
        for (const Storage& storage : storages()) writer.unpacking(name, storage);
    }
    std::ofstream file(arguments[1]);
    file << writer.result();
    return file.flush() ? 0 : 1;
}
