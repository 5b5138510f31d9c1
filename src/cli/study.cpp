// lobelia study: tables and graphs of formulae, encoders and bakes.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/common.h"
#include "cli/environment_input.h"
#include "cli/lobe_files.h"
#include "cli/options.h"
#include "cli/scene_input.h"
#include "cli/verbs.h"
#include "io/json.h"
#include "measure/study/studies.h"
#include "measure/study/study_bake.h"
#include "measure/study/study_encoders.h"
#include "report/study_report.h"

namespace lobelia::cli {
namespace {

struct StudyArguments {
    std::string out = "lobelia-study";
    EnvironmentOptions environment;
    std::vector<std::string> bases = default_study_bases();
    EncoderStudyOptions encoders;
    SceneSource scene;
    BakeStudyOptions bake;
    int bounces = 8;
};

/// Prints the tables and writes NAME.html, NAME.json and NAME.md.
Status write_study(const Result<Study>& study, const std::filesystem::path& folder) {
    if (!study) return study.error();
    const auto html = study_html(*study);
    if (!html) return html.error();
    const auto file = [&](const char* extension) { return folder / (study->name + extension); };
    const std::string markdown = to_markdown(*study);
    const auto json = figures_text(to_json(*study));
    if (!json) return json.error();
    const FileContent files[] = {{file(".html"), *html}, {file(".json"), *json}, {file(".md"), markdown}};
    if (auto status = write_into_folder(folder, files); !status) return status;
    print_text(markdown + "\n");
    print_line(file(".html").string());
    return Done{};
}

Result<Study> encoder_study(const StudyArguments& arguments) {
    const auto environment = load(arguments.environment);
    if (!environment) return environment.error();
    return study_encoders(environment->image, arguments.bases, arguments.encoders, progress_bar());
}

Result<Study> bake_study(const StudyArguments& arguments) {
    const auto loaded = load_scene(arguments.scene);
    if (!loaded) return loaded.error();
    BakeOptions bake;
    bake.codec.clear();
    bake.paths.bounces = arguments.bounces;
    const std::atomic<bool> never = false;
    return study_bake(loaded->scene, bake, arguments.bake, never, progress_bar());
}

void add_encoder_options(CLI::App& command, StudyArguments& a) {
    add_environment_options(command, a.environment);
    command.add_option("--basis", a.bases, "Bases to study")
        ->transform(CLI::Validator(replace_lobe_file, ""))
        ->capture_default_str();
    command.add_option("--repetitions", a.encoders.repetitions, "Runs to average")
        ->check(CLI::Range(std::size_t{1}, std::size_t{10000}))
        ->capture_default_str();
    command.add_option("--seed", a.encoders.seed, "Random seed")->capture_default_str();
    command.add_option("--noise", a.encoders.noise_variance, "Variance of the path noise")
        ->check(number_in(0, 100))
        ->capture_default_str();
}

void add_bake_options(CLI::App& command, StudyArguments& a) {
    add_scene_options(command, a.scene);
    command.add_option("--basis", a.bake.bases, "Bases to measure (default: all listed)")
        ->transform(CLI::Validator(replace_lobe_file, ""));
    command.add_option("--texels", a.bake.texels, "Number of lightmap texels, spread evenly")
        ->check(CLI::Range(std::size_t{1}, std::size_t{100'000}))
        ->capture_default_str();
    command.add_option("--samples", a.bake.samples, "Samples for each codec at each texel")
        ->check(CLI::Range(64u, 65536u))
        ->capture_default_str();
    command.add_option("--reference-samples", a.bake.reference_samples, "Samples for the reference at each texel")
        ->check(CLI::Range(64u, 1'048'576u))
        ->capture_default_str();
    command.add_option("--bounces", a.bounces, "Maximum number of bounces")
        ->check(CLI::Range(0, 64))
        ->capture_default_str();
}

}  // namespace

Verb add_study(CLI::App& app) {
    auto a = std::make_shared<StudyArguments>();
    CLI::App* command = app.add_subcommand("study", "Measure formulae and encoders; write tables and graphs");
    command->require_subcommand(1);
    std::vector<std::pair<CLI::App*, std::function<Result<Study>()>>> studies_by_command;
    for (const StudyEntry& entry : studies())
        studies_by_command.emplace_back(
            command->add_subcommand(std::string(entry.name), std::string(entry.description)), entry.run);
    CLI::App* encoders =
        command->add_subcommand("encoders", "Encoders against the number of samples, with and without path noise");
    add_encoder_options(*encoders, *a);
    studies_by_command.emplace_back(encoders, [a] { return encoder_study(*a); });
    CLI::App* bake = command->add_subcommand("bake", "Irradiance of every codec at the texels of a scene");
    add_bake_options(*bake, *a);
    studies_by_command.emplace_back(bake, [a] { return bake_study(*a); });

    for (const auto& [study, run] : studies_by_command) add_out_option(*study, a->out, "Folder of the study");
    return {command, [=]() -> Status {
                if (auto status = check_folder(a->out); !status) return status;
                for (const auto& [study, run] : studies_by_command)
                    if (study->parsed()) return write_study(run(), a->out);
                return Done{};
            }};
}

}  // namespace lobelia::cli
