// lobelia study: tables and graphs of how good formulae and encoders are.
#include <fmt/core.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/common.h"
#include "cli/scene_input.h"
#include "cli/verbs.h"
#include "io/write_file.h"
#include "measure/study/studies.h"
#include "measure/study/study_bake.h"
#include "measure/study/study_encoders.h"
#include "report/study_page.h"

namespace lobelia::cli {
namespace {

/// The first listed basis of each domain.
std::vector<std::string> first_bases() {
    std::vector<std::string> names;
    for (Domain domain : {Domain::sphere, Domain::hemisphere})
        for (const auto& name : basis_names())
            if (make_basis(name).value()->domain() == domain) {
                names.push_back(name);
                break;
            }
    return names;
}

struct StudyArguments {
    std::string out = "lobelia-study";
    EnvironmentOptions environment;
    std::vector<std::string> bases = first_bases();
    EncoderStudyOptions encoders;
    SceneSource scene;
    BakeStudyOptions bake;
    int bounces = 8;
};

/// Prints the tables and writes NAME.html, NAME.json and NAME.md.
Status write_study(const Study& study, const std::filesystem::path& folder) {
    const auto page = study_html(study);
    if (!page) return page.error();
    const auto file = [&](const char* extension) { return folder / (study.name + extension); };
    const std::string markdown = to_markdown(study), json = to_json(study).dump(1) + "\n";
    const FileContent files[] = {{file(".html"), *page}, {file(".json"), json}, {file(".md"), markdown}};
    if (auto status = write_into_folder(folder, files); !status) return status;
    fmt::print("{}\n{}\n", markdown, file(".html").string());
    return Done{};
}

/// Every codec at the texels of a scene.
Status run_bake_study(const StudyArguments& options) {
    if (auto status = check_folder(options.out); !status) return status;
    const auto loaded = load_scene(options.scene);
    if (!loaded) return loaded.error();
    BakeOptions bake;
    bake.codec.clear();
    bake.paths.bounces = options.bounces;
    const std::atomic<bool> never = false;
    const auto study = study_bake(loaded->scene, bake, options.bake, never, progress_bar());
    if (!study) return study.error();
    return write_study(*study, options.out);
}

void add_bake_options(CLI::App& command, StudyArguments& options) {
    add_scene_options(command, options.scene);
    command.add_option("--out", options.out, "Folder of the study")->capture_default_str();
    command.add_option("--basis", options.bake.bases, "Only these bases (default: all of the list)");
    command.add_option("--texels", options.bake.texels, "How many, spread evenly, 1 to 100000")
        ->check(CLI::Range(std::size_t{1}, std::size_t{100'000}))
        ->capture_default_str();
    command.add_option("--samples", options.bake.samples, "For each codec at each texel, 64 to 65536")
        ->check(CLI::Range(64u, 65536u))
        ->capture_default_str();
    command.add_option("--reference-samples", options.bake.reference_samples, "For the reference, 64 to 1048576")
        ->check(CLI::Range(64u, 1'048'576u))
        ->capture_default_str();
    command.add_option("--bounces", options.bounces, "Surfaces that light may meet, 0 to 64")
        ->check(CLI::Range(0, 64))
        ->capture_default_str();
}

}  // namespace

Verb add_study(CLI::App& app) {
    auto options = std::make_shared<StudyArguments>();
    CLI::App* command = app.add_subcommand("study", "Measure formulae and encoders; write tables and graphs");
    command->require_subcommand(1);

    std::vector<std::pair<CLI::App*, const StudyEntry*>> formulae;
    for (const StudyEntry& entry : studies()) {
        CLI::App* study = command->add_subcommand(std::string(entry.name), std::string(entry.description));
        study->add_option("--out", options->out, "Folder of the study")->capture_default_str();
        formulae.emplace_back(study, &entry);
    }

    CLI::App* encoders =
        command->add_subcommand("encoders", "Encoders against the number of samples, with and without path noise");
    add_environment_options(*encoders, options->environment);
    encoders->add_option("--out", options->out, "Folder of the study")->capture_default_str();
    encoders->add_option("--basis", options->bases, "Bases to study")->capture_default_str();
    encoders->add_option("--repetitions", options->encoders.repetitions, "Runs to average, 1 to 10000")
        ->check(CLI::Range(std::size_t{1}, std::size_t{10000}))
        ->capture_default_str();
    encoders->add_option("--seed", options->encoders.seed, "Of all samples")->capture_default_str();
    encoders->add_option("--noise", options->encoders.noise_variance, "Variance of the path noise, 0 to 100")
        ->check(number_in(0, 100))
        ->capture_default_str();

    CLI::App* bake = command->add_subcommand("bake", "Every codec's irradiance at the texels of a scene");
    add_bake_options(*bake, *options);

    return {command, [=]() -> Status {
                if (bake->parsed()) return run_bake_study(*options);
                for (const auto& [study, entry] : formulae)
                    if (study->parsed()) return write_study(entry->run(), options->out);
                if (auto status = check_folder(options->out); !status) return status;
                const auto environment = load(options->environment);
                if (!environment) return environment.error();
                const auto study =
                    study_encoders(environment->image, options->bases, options->encoders, progress_bar());
                if (!study) return study.error();
                return write_study(*study, options->out);
            }};
}

}  // namespace lobelia::cli
