// lobelia advise: recommends a codec and a storage for an environment, or for a scene's lightmaps.
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "bake/write/manifest.h"
#include "cli/bake_input.h"
#include "cli/common.h"
#include "cli/environment_input.h"
#include "cli/options.h"
#include "cli/verbs.h"
#include "io/json.h"
#include "measure/candidates.h"
#include "report/study_report.h"
#include "scene/embedded.h"

namespace lobelia::cli {
namespace {

struct AdviseArguments {
    EnvironmentOptions environment;  ///< its path may name a bake or a scene, too
    AdviceOptions advice;
    double target = 100 * AdviceOptions().target;  ///< [per cent]
    Domain domain = Domain::sphere;
    std::size_t texels = 300;
    std::string out;
};

bool is_scene(const std::string& path) {
    const auto names = embedded_scene_names();
    const auto extension = std::filesystem::path(path).extension();
    return extension == ".glb" || extension == ".gltf" || std::find(names.begin(), names.end(), path) != names.end();
}

Result<LoadedScene> load_scene_for(const AdviseArguments& arguments) {
    SceneSource scene;
    scene.path = arguments.environment.path;
    scene.ldr = arguments.environment.read.ldr ? Switch::on : Switch::off;
    scene.sanitize = arguments.environment.read.sanitize ? Switch::on : Switch::off;
    if (!is_bake(scene.path)) return load_scene(scene);
    const auto manifest = read_manifest(scene.path);
    if (!manifest) return manifest.error();
    return read_baked_scene(scene.path, *manifest, scene);
}

Result<Advice> advice_for(const AdviseArguments& arguments) {
    if (is_bake(arguments.environment.path) || is_scene(arguments.environment.path)) {
        const auto scene = load_scene_for(arguments);
        if (!scene) return scene.error();
        for (const auto& warning : scene->warnings) complain("lobelia: warning: " + warning);
        return advise(scene->scene, arguments.texels, arguments.advice, progress_bar());
    }
    const auto environment = load(arguments.environment);
    if (!environment) return environment.error();
    return advise(environment->image, arguments.domain, arguments.advice, progress_bar());
}

Status write_advice(const Advice& advice, const std::string& subject, const std::filesystem::path& folder) {
    const auto html = study_html(to_study(advice, subject));
    if (!html) return html.error();
    const auto json = figures_text(to_json(advice));
    if (!json) return json.error();
    const FileContent files[] = {{folder / "advice.html", *html}, {folder / "advice.json", *json}};
    if (auto status = write_into_folder(folder, files); !status) return status;
    print_line((folder / "advice.html").string());
    return Done{};
}

Status advise_verb(AdviseArguments arguments) {
    arguments.advice.target = arguments.target / 100;
    if (!arguments.out.empty())
        if (auto status = check_folder(arguments.out); !status) return status;
    const auto advice = advice_for(arguments);
    if (!advice) return advice.error();
    print_text(to_text(*advice));
    if (arguments.out.empty()) return Done{};
    return write_advice(*advice, std::filesystem::path(arguments.environment.path).filename().string(), arguments.out);
}

}  // namespace

Verb add_advise(CLI::App& app) {
    auto a = std::make_shared<AdviseArguments>();
    CLI::App* command = app.add_subcommand("advise", "Recommend a codec and a storage by error, bytes and time");
    add_environment_options(*command, a->environment);
    command->get_option("ENV")->description(
        "A latitude-longitude environment, \"sky\", the folder of a bake, or a scene (for its lightmaps)");
    add_enum_option<Need>(
        *command, "--need", a->advice.need,
        {{"irradiance", Need::irradiance}, {"radiance", Need::radiance}, {"specular", Need::specular}},
        "Quantity that the coefficients are evaluated for");
    command->add_option("--budget", a->advice.budget, "Maximum bytes for a texel or probe (default: no limit)")
        ->check(number_in(1, 1e6));
    command
        ->add_option("--target", a->target,
                     "Error that is small enough, in per cent of the mean; the fewest bytes that reach it are "
                     "recommended")
        ->check(number_in(0, 1000))
        ->capture_default_str();
    add_enum_option<Domain>(*command, "--domain", a->domain,
                            {{"sphere", Domain::sphere}, {"hemisphere", Domain::hemisphere}},
                            "Directions of an environment to measure: all, for probes, or those above z = 0, for "
                            "surfaces");
    command->add_option("--texels", a->texels, "Number of lightmap texels of a scene to measure, spread evenly")
        ->check(CLI::Range(std::size_t{1}, std::size_t{10'000}))
        ->capture_default_str();
    add_out_option(*command, a->out, "Folder for advice.html and advice.json, with all Pareto-optimal candidates");
    return {command, [a] { return advise_verb(*a); }};
}

}  // namespace lobelia::cli
