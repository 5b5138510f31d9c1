// lobelia encode: coefficients of an environment, as a file for scripts.
#include "cli/common.h"
#include "cli/environment_input.h"
#include "cli/lobe_files.h"
#include "cli/options.h"
#include "cli/verbs.h"

namespace lobelia::cli {
namespace {

struct EncodeArguments {
    EnvironmentOptions environment;
    SamplingOptions sampling;
    std::string codec;
    std::string out;
};

Status encode_verb(const EncodeArguments& arguments) {
    // Names first, then files.
    if (const auto codec = make_codec(arguments.codec); !codec) return codec.error();
    const auto environment = load(arguments.environment);
    if (!environment) return environment.error();
    const auto file = encode(environment->image, arguments.codec, arguments.sampling);
    if (!file) return Error{environment->info.name + ": " + file.error().message};
    return write_file_atomically(arguments.out, to_text(*file));
}

}  // namespace

Verb add_encode(CLI::App& app) {
    auto a = std::make_shared<EncodeArguments>();
    CLI::App* command = app.add_subcommand("encode", "Encode an environment; write its coefficients as JSON");
    add_environment_options(*command, a->environment);
    add_sampling_options(*command, a->sampling);
    command->add_option("--codec", a->codec, "basis/encoder/evaluator, see lobelia list")
        ->transform(CLI::Validator(replace_lobe_file, ""))
        ->required();
    add_out_option(*command, a->out, "Output file")->required();
    return {command, [a] { return encode_verb(*a); }};
}

}  // namespace lobelia::cli
