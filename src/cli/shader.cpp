// lobelia shader: the functions that a renderer needs to unpack and evaluate a codec.
#include "shade/shader.h"
#include "cli/common.h"
#include "cli/lobe_files.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/verbs.h"

namespace lobelia::cli {
namespace {

struct ShaderArguments {
    std::string codec, storage, language = "glsl", out;
    std::vector<std::string> needs;
};

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
        request.needs.push_back(name == "radiance" ? shade::Need::radiance
                                : name == "probes" ? shade::Need::probes
                                                   : shade::Need::irradiance);
    const auto text = shade::shader_text(*codec, request);
    if (!text) return text.error();
    if (!arguments.out.empty()) return write_file_atomically(arguments.out, *text);
    print_text(*text);
    return Done{};
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
    command
        ->add_option("--need", a->needs,
                     "Functions to write; probes: the weights of the probes around a place (default: irradiance)")
        ->check(CLI::IsMember({"irradiance", "radiance", "probes"}))
        ->delimiter(',');
    add_out_option(*command, a->out, "Output file (default: standard output)");
    return {command, [a] { return shader_verb(*a); }};
}

}  // namespace lobelia::cli
