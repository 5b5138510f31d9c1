// lobelia reference: exact irradiance or radiance of an environment.
#include "cli/common.h"
#include "cli/environment_input.h"
#include "cli/evaluation_output.h"
#include "cli/options.h"
#include "cli/verbs.h"
#include "measure/comparison.h"

namespace lobelia::cli {
namespace {

struct ReferenceArguments {
    EnvironmentOptions environment;
    EvaluationOptions output;
};

Status reference_verb(const ReferenceArguments& arguments) {
    const EvaluationOptions& output = arguments.output;
    const auto target = target_of(output, Domain::sphere);
    if (!target) return target.error();
    const auto environment = load(arguments.environment);
    if (!environment) return environment.error();
    const Image& image = environment->image;
    if (!output.radiance) {
        const Image reduced = resize(image, reduced_grid(lat_long(image), SamplingOptions().most_texels));
        return write_values(output, *target, exact_irradiance(texel_samples(reduced), target->directions));
    }
    if (!output.lat_long.empty()) return write_values(output, *target, radiance_of(resize(image, target->grid)));
    Colours values(target->directions.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        set_entry(values.view(), i, image.pixels[lat_long(image).index(direction_at(target->directions, i))]);
    return write_values(output, *target, values);
}

}  // namespace

Verb add_reference(CLI::App& app) {
    auto a = std::make_shared<ReferenceArguments>();
    CLI::App* command = app.add_subcommand("reference",
                                           "Exact irradiance E [W/m^2] of an environment, summed over its texels "
                                           "(above 131072, of the reduced one); or its radiance");
    add_environment_options(*command, a->environment);
    add_evaluation_options(*command, a->output);
    return {command, [a] { return reference_verb(*a); }};
}

}  // namespace lobelia::cli
