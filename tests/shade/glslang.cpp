#include "glslang.h"

#include <cstdlib>
#include <cstring>

#include "folders.h"

namespace lobelia::test {
namespace {

/// Runs glslangValidator on a text; `options` say what to do with it, and may name the result "spirv".
Status run(const TestFolder& folder, const std::string& text, const std::string& options) {
    overwrite(folder.path() / "text", text);
    const std::string command =
        "cd '" + folder.path().string() + "' && glslangValidator " + options + " text >messages 2>&1";
    if (std::system(command.c_str()) == 0) return Done{};
    return Error{contents(folder.path() / "messages")};
}

}  // namespace

bool has_glslang() {
    static const bool k_found = std::system("glslangValidator --version >/dev/null 2>&1") == 0;
    return k_found;
}

Result<std::vector<std::uint32_t>> spirv_of(const std::string& text, shade::Language language) {
    const TestFolder folder("glslang");
    const std::string options = language == shade::Language::hlsl ? "-D -e main" : "";
    if (const Status status = run(folder, text, options + " -V -S comp -o spirv"); !status) return status.error();
    const std::string bytes = contents(folder.path() / "spirv");
    std::vector<std::uint32_t> words(bytes.size() / sizeof(std::uint32_t));
    std::memcpy(words.data(), bytes.data(), words.size() * sizeof(std::uint32_t));
    return words;
}

Status check_fragment_shader(const std::string& text, shade::Language language) {
    const TestFolder folder("glslang");
    return run(folder, text, language == shade::Language::hlsl ? "-D -e main -V -S frag -o spirv" : "-S frag");
}

}  // namespace lobelia::test
