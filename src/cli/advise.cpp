// lobelia advise: which codec and storage to take for an environment, or for a scene's lightmaps.
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "bake/write/manifest.h"
#include "cli/bake_input.h"
#include "cli/common.h"
#include "cli/verbs.h"
#include "measure/advice.h"
#include "measure/specular_errors.h"
#include "measure/study/study_bake.h"
#include "report/study_page.h"
#include "scene/embedded.h"

namespace lobelia::cli {
namespace {

struct AdviseArguments {
    EnvironmentOptions environment;  ///< its path may name a bake or a scene, too
    AdviceOptions advice;
    std::string need = "irradiance";
    double target = 100 * AdviceOptions().target;  ///< [percent]
    Domain domain = Domain::sphere;
    std::size_t texels = 300;
    std::string out;
};

std::vector<const Storage*> all_storages() {
    std::vector<const Storage*> all;
    for (const Storage& storage : storages()) all.push_back(&storage);
    return all;
}

/// Those whose error depends on nothing but a texel's own coefficients.
std::vector<const Storage*> storages_of_single_texels() {
    std::vector<const Storage*> single = all_storages();
    std::erase_if(single, [](const Storage* storage) { return shares_texels(*storage); });
    return single;
}

double mean_of(Rgb colour) { return (double{colour.r} + colour.g + colour.b) / 3; }

double error_of(const Method& method, Need need) {
    return need == Need::radiance ? method.radiance.rms : method.irradiance_over_pi.rms;
}

/// For each basis and evaluator the codec of the best encoder: the others take as many bytes.
std::vector<CodecName> best_codecs(const Comparison& comparison, const AdviseArguments& options) {
    std::map<std::pair<std::string, std::string>, const Method*> best;
    for (const Method& m : comparison.methods) {
        if (m.domain != options.domain) continue;
        const Method*& known = best[{m.name.basis, m.name.evaluator}];
        if (known == nullptr || error_of(m, options.advice.need) < error_of(*known, options.advice.need)) known = &m;
    }
    std::vector<CodecName> names;
    for (const auto& [key, method] : best) names.push_back(method->name);
    return names;
}

Result<std::vector<Candidate>> candidates_for_gloss(const Image& environment, const AdviseArguments& options) {
    if (options.domain == Domain::hemisphere)
        return Error{"--need specular: gloss is judged all around; leave --domain hemisphere out"};
    GlossOptions judging;
    judging.storages = storages_of_single_texels();
    std::vector<Candidate> candidates;
    for (const GlossError& e : gloss_errors(environment, judging))
        candidates.push_back({{e.basis, e.encoder, e.reading}, e.storage, e.bytes, e.error, e.nanoseconds});
    return candidates;
}

Result<std::vector<Candidate>> candidates_for_environment(const AdviseArguments& options) {
    auto environment = load(options.environment);
    if (!environment) return environment.error();
    if (options.advice.need == Need::specular) return candidates_for_gloss(environment->image, options);
    ComparisonOptions comparing;
    comparing.pictures = comparing.convergence = false;
    const auto first = compare(environment->image, all_codecs(), comparing, progress_bar());
    if (!first) return first.error();
    comparing.storages = storages_of_single_texels();
    const auto comparison = compare(environment->image, best_codecs(*first, options), comparing, progress_bar());
    if (!comparison) return comparison.error();

    const Need need = options.advice.need;
    const double mean = mean_of(comparison->mean_radiance);
    std::vector<Candidate> candidates;
    for (const Method& m : comparison->methods)
        for (const StorageErrors& s : m.storage)
            // What a storage cut is told by the error of this environment, but not of the next.
            if (s.cut == 0)
                candidates.push_back({m.name, s.storage, s.bytes,
                                      (need == Need::radiance ? s.radiance_rms : s.irradiance_over_pi_rms) / mean,
                                      need == Need::irradiance ? m.evaluate_ns_per_normal : 0});
    return candidates;
}

bool is_scene(const std::string& path) {
    const auto names = embedded_scene_names();
    const auto extension = std::filesystem::path(path).extension();
    return extension == ".glb" || extension == ".gltf" || std::find(names.begin(), names.end(), path) != names.end();
}

Result<LoadedScene> load_scene_for(const AdviseArguments& options) {
    SceneSource scene;
    scene.path = options.environment.path;
    scene.ldr = options.environment.read.ldr ? Switch::on : Switch::off;
    scene.sanitize = options.environment.read.sanitize ? Switch::on : Switch::off;
    if (!is_bake(scene.path)) return load_scene(scene);
    const auto manifest = read_manifest(scene.path);
    if (!manifest) return manifest.error();
    return read_baked_scene(scene.path, *manifest, scene);
}

Result<std::vector<Candidate>> candidates_for_scene(const AdviseArguments& options) {
    if (options.advice.need != Need::irradiance)
        return Error{"--need: of lightmaps only the irradiance is known well enough to judge by"};
    const auto scene = load_scene_for(options);
    if (!scene) return scene.error();
    for (const auto& warning : scene->warnings) complain("lobelia: warning: " + warning);
    BakeOptions bake;
    bake.codec.clear();
    BakeStudyOptions studying;
    studying.texels = options.texels;
    studying.reference_samples = 4096;
    studying.storages = all_storages();
    const std::atomic<bool> never = false;
    const auto judged = judge_baked_codecs(scene->scene, bake, studying, never, progress_bar());
    if (!judged) return judged.error();
    std::vector<Candidate> candidates;
    for (const BakedCodec& c : judged->codecs)
        if (c.storage != nullptr) candidates.push_back({c.name, std::string(c.storage->name), c.bytes, c.tilted, 0});
    return candidates;
}

void print_advice(const Advice& advice) {
    const std::string error = fmt::format("{} error", to_string(advice.options.need));
    fmt::print("{:<42} {:<14} {:>8} {:>17} {:>8}\n", "codec", "storage", "bytes", error, "ns");
    // Of the front, what is best for its bytes; the page has all of it.
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < advice.front.size(); ++i) {
        const Candidate& c = advice.front[i];
        if (c.error >= least && i != advice.recommended) continue;
        least = std::min(least, c.error);
        fmt::print("{:<42} {:<14} {:>8.4g} {:>15.3g} % {:>8} {}\n", c.codec.str(), c.storage, c.bytes, 100 * c.error,
                   c.nanoseconds > 0 ? fmt::format("{:.1f}", c.nanoseconds) : "", i == advice.recommended ? "<-" : "");
    }
    fmt::print("\n{}\n", advice.reason);
}

Status write_advice(const Advice& advice, const std::string& subject, const std::filesystem::path& folder) {
    const auto page = study_html(to_study(advice, subject));
    if (!page) return page.error();
    const std::string json = to_json(advice).dump(1) + "\n";
    const FileContent files[] = {{folder / "advice.html", *page}, {folder / "advice.json", json}};
    if (auto status = write_into_folder(folder, files); !status) return status;
    fmt::print("{}\n", (folder / "advice.html").string());
    return Done{};
}

Status advise_verb(AdviseArguments options) {
    if (options.need == "radiance") options.advice.need = Need::radiance;
    if (options.need == "specular") options.advice.need = Need::specular;
    options.advice.target = options.target / 100;
    if (!options.out.empty())
        if (auto status = check_folder(options.out); !status) return status;
    const std::string& path = options.environment.path;
    auto candidates =
        is_bake(path) || is_scene(path) ? candidates_for_scene(options) : candidates_for_environment(options);
    if (!candidates) return candidates.error();
    const auto advice = advise(*std::move(candidates), options.advice);
    if (!advice) return Error{"--budget: " + advice.error().message};
    print_advice(*advice);
    if (options.out.empty()) return Done{};
    return write_advice(*advice, std::filesystem::path(path).filename().string(), options.out);
}

}  // namespace

Verb add_advise(CLI::App& app) {
    auto options = std::make_shared<AdviseArguments>();
    CLI::App* command = app.add_subcommand("advise", "Recommend a codec and a storage by error, bytes and time");
    add_environment_options(*command, options->environment);
    command->get_option("ENV")->description(
        "A latitude-longitude environment, \"sky\", a bake's folder, or a scene whose lightmaps are meant");
    command->add_option("--need", options->need, "What is read from the coefficients")
        ->check(CLI::IsMember({"irradiance", "radiance", "specular"}))
        ->capture_default_str();
    command->add_option("--budget", options->advice.budget, "Bytes for a texel or probe at most (default: no limit)")
        ->check(number_in(1, 1e6));
    command
        ->add_option("--target", options->target,
                     "The error that is small enough, in percent of the mean: the fewest bytes that reach it are "
                     "recommended")
        ->check(number_in(0, 1000))
        ->capture_default_str();
    command
        ->add_option("--domain", options->domain,
                     "Of an environment: the sphere, for probes, or the hemisphere above z = 0, for surfaces")
        ->transform(CLI::CheckedTransformer(
            std::map<std::string, Domain>{{"sphere", Domain::sphere}, {"hemisphere", Domain::hemisphere}}))
        ->default_str("sphere");
    command->add_option("--texels", options->texels, "Of a scene: how many to judge by, spread evenly, 1 to 10000")
        ->check(CLI::Range(std::size_t{1}, std::size_t{10'000}))
        ->capture_default_str();
    command->add_option("--out", options->out, "Folder for advice.html and advice.json, with the whole front");
    return {command, [options] { return advise_verb(*options); }};
}

}  // namespace lobelia::cli
