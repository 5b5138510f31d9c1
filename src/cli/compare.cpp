// lobelia compare: every codec on an environment, as a page and a JSON file.
#include <fmt/core.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "cli/common.h"
#include "cli/lobe_files.h"
#include "cli/verbs.h"
#include "io/write_file.h"
#include "measure/recipe.h"

namespace lobelia::cli {
namespace {

struct CompareArguments {
    EnvironmentOptions environment;
    SamplingOptions sampling;
    std::string out = "lobelia-report";
    std::vector<std::string> codecs, bases, encoders, evaluators, storages;
    std::string recipe;
    bool json_only = false;
    bool no_convergence = false;
};

/// The codecs that the options name: those of --codec, or the list's (and any other basis named), filtered.
Result<std::vector<CodecName>> chosen_codecs(const CompareArguments& options) {
    if (!options.codecs.empty()) {
        std::vector<CodecName> chosen;
        for (const auto& name : options.codecs) {
            const auto codec = make_codec(name);
            if (!codec) return codec.error();
            if (std::find(chosen.begin(), chosen.end(), codec->name()) == chosen.end()) chosen.push_back(codec->name());
        }
        return chosen;
    }
    const auto wants = [](const std::vector<std::string>& wanted, const std::string& name) {
        return wanted.empty() || std::find(wanted.begin(), wanted.end(), name) != wanted.end();
    };
    auto known_encoders = encoder_names();
    const auto variants = encoder_variant_names();
    known_encoders.insert(known_encoders.end(), variants.begin(), variants.end());
    for (const auto& name : options.encoders)
        if (!wants(known_encoders, name))
            return Error{"unknown encoder \"" + name + "\"" + nearest_names(name, known_encoders)};
    std::vector<CodecName> chosen;
    std::vector<std::string> known_evaluators;
    std::vector<std::string> bases;
    for (const auto& name : options.bases.empty() ? basis_names() : options.bases)
        if (std::find(bases.begin(), bases.end(), name) == bases.end()) bases.push_back(name);
    for (const auto& basis_name : bases) {
        const auto basis = make_basis(basis_name);
        if (!basis) return basis.error();
        const auto evaluators = (*basis)->evaluator_names();
        known_evaluators.insert(known_evaluators.end(), evaluators.begin(), evaluators.end());
        // Variants for study run only where they are named.
        auto encoders = encoder_names(**basis);
        for (const auto& name : variants)
            if (!options.encoders.empty() && make_encoder(name, *basis)) encoders.push_back(name);
        for (const auto& encoder : encoders)
            for (const auto& evaluator : evaluators)
                if (wants(options.encoders, encoder) && wants(options.evaluators, evaluator))
                    chosen.push_back({basis_name, encoder, evaluator});
    }
    std::sort(known_evaluators.begin(), known_evaluators.end());
    known_evaluators.erase(std::unique(known_evaluators.begin(), known_evaluators.end()), known_evaluators.end());
    for (const auto& name : options.evaluators)
        if (!wants(known_evaluators, name))
            return Error{"unknown evaluator \"" + name + "\"" + nearest_names(name, known_evaluators)};
    if (chosen.empty()) return Error{"no codec is left: the encoders named do not suit the bases named"};
    return chosen;
}

/// The storages that the options name, each once; "all" is the whole list.
Result<std::vector<const Storage*>> chosen_storages(const CompareArguments& options) {
    std::vector<const Storage*> chosen;
    const auto add_once = [&](const Storage* storage) {
        if (std::find(chosen.begin(), chosen.end(), storage) == chosen.end()) chosen.push_back(storage);
    };
    for (const auto& name : options.storages) {
        if (name == "all") {
            for (const Storage& storage : storages()) add_once(&storage);
            continue;
        }
        const auto storage = find_storage(name);
        if (!storage) return storage.error();
        add_once(*storage);
    }
    return chosen;
}

/// A storage that was named must suit one of the codecs at least.
Status check_used(const std::vector<std::string>& named, const Comparison& comparison) {
    for (const auto& name : named) {
        const bool is_used = std::any_of(comparison.methods.begin(), comparison.methods.end(), [&](const Method& m) {
            return std::any_of(m.storage.begin(), m.storage.end(),
                               [&](const StorageErrors& s) { return s.storage == name; });
        });
        if (name != "all" && !is_used)
            return Error{"--storage " + name +
                         ": it suits none of these codecs; lobelia list --storages CODEC prints those that do"};
    }
    return Done{};
}

Result<Comparison> run(const CompareArguments& options, const Image& environment) {
    ComparisonOptions comparison = comparison_options(options.sampling);
    comparison.pictures = !options.json_only;
    comparison.convergence = !options.json_only && !options.no_convergence;
    if (!options.recipe.empty())
        return run_recipe(options.recipe == "published" ? Recipe::published : Recipe::updated, environment, comparison,
                          progress_bar());
    auto codecs = chosen_codecs(options);
    if (!codecs) return codecs.error();
    auto storages = chosen_storages(options);
    if (!storages) return storages.error();
    comparison.storages = *std::move(storages);
    auto result = compare(environment, *codecs, comparison, progress_bar());
    if (!result) return result;
    if (auto status = check_used(options.storages, *result); !status) return status.error();
    return result;
}

void print_summary(const Comparison& comparison) {
    fmt::print("{:<42} {:>6} {:>12} {:>12} {:>12}\n", "codec", "bytes", "L rms", "E/pi rms", "E sMAPE");
    std::vector<const Method*> ranked;
    for (const auto& method : comparison.methods) ranked.push_back(&method);
    if (comparison.recipe.empty()) {
        std::stable_sort(ranked.begin(), ranked.end(), [](const Method* a, const Method* b) {
            const auto rank = [](const Method& m) {
                const double rms = m.irradiance_over_pi.rms;
                return std::isnan(rms) ? std::numeric_limits<double>::infinity() : rms;
            };
            return rank(*a) < rank(*b);
        });
    }
    constexpr std::size_t most = 12;
    for (std::size_t i = 0; i < std::min(most, ranked.size()); ++i) {
        const Method& m = *ranked[i];
        const bool published = !comparison.recipe.empty();
        fmt::print("{:<42} {:>6} {:>12.6g} {:>12.6g} {:>12.4g}\n", m.name.str(), 12 * m.c.size(),
                   published ? m.radiance.rms_unweighted : m.radiance.rms,
                   published ? m.irradiance_over_pi.rms_unweighted : m.irradiance_over_pi.rms,
                   m.irradiance_over_pi.smape);
    }
    if (ranked.size() > most) fmt::print("... and {} more, in the report\n", ranked.size() - most);
}

/// Of what was stored, the least error of irradiance for so many bytes; the report has all, that of single texels in
/// blocks too, which tells nothing of pages.
void print_stored(const Comparison& comparison) {
    std::vector<std::pair<const Method*, const StorageErrors*>> ranked;
    for (const Method& method : comparison.methods)
        for (const StorageErrors& stored : method.storage)
            if (!shares_texels(**find_storage(stored.storage))) ranked.emplace_back(&method, &stored);
    if (ranked.empty()) return;
    std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) {
        return std::pair(a.second->bytes, a.second->irradiance_over_pi_rms) <
               std::pair(b.second->bytes, b.second->irradiance_over_pi_rms);
    });
    fmt::print("\n{:<42} {:>6} {:>12} {:>12} {:>12}\n", "stored: the least E/pi rms for the bytes", "bytes", "L rms",
               "E/pi rms", "storage");
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [method, stored] : ranked) {
        if (!(stored->irradiance_over_pi_rms < least)) continue;
        least = stored->irradiance_over_pi_rms;
        fmt::print("{:<42} {:>6.4g} {:>12.6g} {:>12.6g} {:>12}\n", method->name.str(), stored->bytes,
                   stored->radiance_rms, stored->irradiance_over_pi_rms, stored->storage);
    }
}

Status compare_verb(const CompareArguments& options) {
    // Names first, then files: what is cheap to refuse is refused first.
    if (options.recipe.empty())
        if (const auto codecs = chosen_codecs(options); !codecs) return codecs.error();
    if (const auto storages = chosen_storages(options); !storages) return storages.error();
    auto environment = load(options.environment);
    if (!environment) return environment.error();
    const std::filesystem::path folder = options.out;
    if (auto status = check_folder(folder); !status) return status;

    const auto comparison = run(options, environment->image);
    if (!comparison) return comparison.error();
    const auto report = to_json(*comparison, environment->info);
    const std::string text = report.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
    const std::string page = options.json_only ? "" : report_html(report, to_pictures(*comparison));
    std::vector<FileContent> files = {{folder / "report.json", text}};
    if (!options.json_only) files.push_back({folder / "report.html", page});
    if (auto status = write_into_folder(folder, files); !status) return status;
    print_summary(*comparison);
    print_stored(*comparison);
    fmt::print("{}\n", (folder / (options.json_only ? "report.json" : "report.html")).string());
    return Done{};
}

}  // namespace

Verb add_compare(CLI::App& app) {
    auto options = std::make_shared<CompareArguments>();
    CLI::App* command =
        app.add_subcommand("compare", "Run codecs on an environment; write report.html and report.json");
    add_environment_options(*command, options->environment);
    add_sampling_options(*command, options->sampling);
    command->add_option("--out", options->out, "Folder of the report")->capture_default_str();
    CLI::Option* codec = command->add_option("--codec", options->codecs,
                                             "Only these, as basis/encoder/evaluator (default: all of the list)");
    CLI::Option* basis = command->add_option("--basis", options->bases,
                                             "Only these bases; also others than the listed, see lobelia list --axes");
    CLI::Option* encoder = command->add_option("--encoder", options->encoders, "Only these encoders");
    CLI::Option* evaluator = command->add_option("--evaluator", options->evaluators, "Only these evaluators");
    for (CLI::Option* named : {codec, basis}) named->transform(CLI::Validator(replace_lobe_file, ""));
    for (CLI::Option* filter : {basis, encoder, evaluator}) codec->excludes(filter);
    CLI::Option* storage = command->add_option("--storage", options->storages,
                                               "Also store the coefficients so and judge what is read back; all: in "
                                               "every storage that suits, see lobelia list --axes");
    command
        ->add_option(
            "--recipe", options->recipe,
            "Reproduce a published table instead: published (2018, first version) or updated (2018, corrected)")
        ->check(CLI::IsMember({"published", "updated"}))
        ->excludes(codec, basis, encoder, evaluator, storage, command->get_option("--sequence"),
                   command->get_option("--samples"), command->get_option("--seed"));
    command->add_flag("--json-only", options->json_only, "Write report.json alone: no page, pictures or convergence");
    command->add_flag("--no-convergence", options->no_convergence, "Leave the convergence plots out");
    return {command, [options] { return compare_verb(*options); }};
}

}  // namespace lobelia::cli
