// lobelia eval: evaluates coefficients, or all lightmaps of a bake.
#include "cli/bake_input.h"
#include "cli/common.h"
#include "cli/eval_bake.h"
#include "cli/evaluation_output.h"
#include "cli/options.h"
#include "cli/verbs.h"
#include "coefficients/coefficient_file.h"

namespace lobelia::cli {
namespace {

struct EvalArguments {
    std::string coefficients;
    std::string evaluator;
    bool irradiance = false;
    EvaluationOptions output;
};

Status eval_verb(const EvalArguments& arguments) {
    const EvaluationOptions& output = arguments.output;
    if (is_bake(arguments.coefficients)) {
        if (!arguments.irradiance || !output.normals.empty() || !output.lat_long.empty())
            return Error{arguments.coefficients +
                         ": a bake is evaluated with --irradiance, at the normal of each texel; leave --normals and "
                         "--latlong out"};
        return eval_bake({arguments.coefficients, arguments.evaluator, output.out});
    }
    const auto text = read_text(arguments.coefficients, 1);
    if (!text) return text.error();
    const auto file = coefficients_from_text(*text, arguments.coefficients);
    if (!file) return file.error();
    CodecName name = file->codec;
    if (!arguments.evaluator.empty()) name.evaluator = arguments.evaluator;
    const auto codec = make_codec(name.str());
    if (!codec) return codec.error();
    const auto target = target_of(output, codec->basis().domain());
    if (!target) return target.error();
    Colours values(target->directions.size());
    if (output.radiance)
        codec->radiance(file->c, target->directions, values);
    else
        codec->irradiance(file->c, target->directions, values);
    return write_values(output, *target, values);
}

}  // namespace

Verb add_eval(CLI::App& app) {
    auto a = std::make_shared<EvalArguments>();
    CLI::App* command = app.add_subcommand(
        "eval", "Evaluate coefficients as irradiance E [W/m^2] (not E / pi) or radiance [W/(m^2 sr)]");
    command
        ->add_option("COEFFICIENTS", a->coefficients,
                     "A file of lobelia encode, or the folder of a bake: then --irradiance -o FOLDER")
        ->required();
    add_evaluation_options(*command, a->output);
    command->add_option("--evaluator", a->evaluator, "Another evaluator of the same basis, see lobelia list --axes");
    command
        ->add_flag("--irradiance", a->irradiance,
                   "Evaluate irradiance (default); of a bake, at the normal of each texel: one .exr with R, G, B and "
                   "validity for each lightmap page")
        ->excludes("--radiance");
    return {command, [a] { return eval_verb(*a); }};
}

}  // namespace lobelia::cli
