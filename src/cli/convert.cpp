// lobelia convert: spherical harmonics from and to the conventions of others.
#include <fmt/core.h>

#include "cli/common.h"
#include "cli/lobe_files.h"
#include "cli/options.h"
#include "cli/verbs.h"
#include "coefficients/convert.h"
#include "lobelia/sh_conventions.h"

namespace lobelia::cli {
namespace {

struct ConvertArguments {
    std::string input, out, mirrored;
    ConvertOptions options;
};

Status convert_verb(const ConvertArguments& arguments) {
    const auto text = read_text(arguments.input);
    if (!text) return text.error();
    ConvertOptions options = arguments.options;
    if (!arguments.mirrored.empty()) options.mirrored = static_cast<Axis>(arguments.mirrored[0] - 'x');
    const auto converted = convert(*text, arguments.input, options);
    if (!converted) return converted.error();
    for (const auto& warning : converted->warnings) complain("lobelia: warning: " + warning);
    return write_file_atomically(arguments.out, converted->text);
}

}  // namespace

Verb add_convert(CLI::App& app) {
    auto a = std::make_shared<ConvertArguments>();
    CLI::App* command = app.add_subcommand(
        "convert", "Convert spherical harmonics from and to DirectX, Unity, three.js, Filament and glTF");
    std::string names;
    for (const ShConvention& convention : sh_conventions())
        names += fmt::format("\n  {}: {}", convention.name, convention.description);
    command->footer("Conventions:" + names);
    command->add_option("FILE", a->input, "A file of lobelia encode, or of the convention that --from names")
        ->required();
    command->add_option("--from", a->options.from, "Convention of the input (default: Lobelia's)");
    CLI::Option* to = command->add_option("--to", a->options.to, "Convention of the output (default: Lobelia's)");
    command
        ->add_option("--mirror", a->mirrored, "Mirror one axis (converts between right- and left-handed coordinates)")
        ->check(CLI::IsMember({"x", "y", "z"}));
    command
        ->add_option("--codec", a->options.codec,
                     "Codec named in the output (default: the first listed one of its degree)")
        ->transform(CLI::Validator(replace_lobe_file, ""))
        ->excludes(to);
    add_out_option(*command, a->out, "Output file")->required();
    return {command, [a] { return convert_verb(*a); }};
}

}  // namespace lobelia::cli
