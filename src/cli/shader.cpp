// lobelia shader: the functions that a renderer needs to unpack and evaluate a codec.
#include <algorithm>

#include "bake/write/ggx_table_file.h"
#include "cli/common.h"
#include "cli/lobe_files.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/verbs.h"
#include "shade/shader.h"

namespace lobelia::cli {
namespace {

struct ShaderArguments {
    std::string codec, storage, specular, table, language = "glsl", out;
    std::vector<std::string> needs;
};

/// Writes to a file, or to standard output if `path` is empty.
Status put(const std::string& text, const std::string& path) {
    if (!path.empty()) return write_file_atomically(path, text);
    print_text(text);
    return Done{};
}

Status shader_verb(const ShaderArguments& arguments) {
    const auto codec = make_codec(arguments.codec);
    if (!codec) return codec.error();
    shade::ShaderRequest request;
    request.language = *shade::language_from_name(arguments.language);
    if (!arguments.storage.empty()) {
        const auto storage = find_storage(arguments.storage);
        if (!storage) return storage.error();
        request.storage = *storage;
    }
    if (!arguments.needs.empty()) request.needs.clear();
    for (const auto& name : arguments.needs)
        for (const auto& entry : shade::needs())
            if (entry.name == name) request.needs.push_back(entry.need);
    const auto& needs = request.needs;
    if (std::find(needs.begin(), needs.end(), shade::Need::specular) == needs.end() &&
        !(arguments.specular.empty() && arguments.table.empty()))
        return Error{"--specular and --table are for specular code: add --need specular"};
    request.specular = arguments.specular;
    const auto text = shade::shader_text(*codec, request);
    if (!text) return text.error();
    if (arguments.table.empty()) return put(*text, arguments.out);
    // The table takes its place once the text has been written.
    auto table = stage_ggx_table(arguments.table);
    if (!table) return table.error();
    const Status status = put(*text, arguments.out);
    return status ? table->commit() : status;
}

}  // namespace

Verb add_shader(CLI::App& app) {
    auto a = std::make_shared<ShaderArguments>();
    CLI::App* command = app.add_subcommand("shader", "Write shader code that unpacks and evaluates a codec");
    command->add_option("CODEC", a->codec, "basis/encoder/evaluator, see lobelia list")
        ->transform(CLI::Validator(replace_lobe_file, ""))
        ->required();
    std::vector<std::string> languages;
    std::string described = "Languages:";
    for (const auto& entry : shade::languages()) {
        languages.emplace_back(entry.name);
        described += fmt::format("\n  {}: {}", entry.name, entry.description);
    }
    command->footer(described);
    command->add_option("--storage", a->storage, "Also unpack textures of this storage, see lobelia list --axes");
    command->add_option("--language", a->language, "Language of the code")
        ->check(CLI::IsMember(languages))
        ->capture_default_str();
    std::vector<std::string> needs;
    for (const auto& entry : shade::needs()) needs.emplace_back(entry.name);
    command
        ->add_option("--need", a->needs,
                     "Functions to write; probes: the weights of the probes around a place (default: irradiance)")
        ->check(CLI::IsMember(needs))
        ->delimiter(',');
    command->add_option("--specular", a->specular,
                        "Specular evaluator, see lobelia list --axes (default: the basis's most accurate one)");
    command->add_option("--table", a->table, "Also write the texture that specular code samples, as .ktx2 or .dds");
    add_out_option(*command, a->out, "Output file (default: standard output)");
    return {command, [a] { return shader_verb(*a); }};
}

}  // namespace lobelia::cli
