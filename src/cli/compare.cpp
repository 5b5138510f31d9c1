// lobelia compare: codecs on an environment, as an HTML report and a JSON file.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/common.h"
#include "cli/environment_input.h"
#include "cli/lobe_files.h"
#include "cli/options.h"
#include "cli/verbs.h"
#include "io/json.h"
#include "measure/compare_job.h"
#include "measure/comparison_text.h"
#include "report/comparison_report.h"

namespace lobelia::cli {
namespace {

enum class Table { codecs, published, updated };

struct CompareArguments {
    EnvironmentOptions environment;
    CompareJob job;
    Table table = Table::codecs;
    std::string out = "lobelia-report";
    bool json_only = false, no_convergence = false;
};

Status write_report(const CompareArguments& arguments, const Comparison& comparison, const EnvironmentInfo& info) {
    const std::filesystem::path folder = arguments.out;
    const auto report = to_json(comparison, info);
    const auto text = figures_text(report);
    if (!text) return text.error();
    const std::string html = arguments.json_only ? "" : comparison_html(report, to_pictures(comparison));
    std::vector<FileContent> files = {{folder / "report.json", *text}};
    if (!arguments.json_only) files.push_back({folder / "report.html", html});
    if (auto status = write_into_folder(folder, files); !status) return status;
    print_text(summary_text(comparison) + stored_text(comparison));
    print_line(files.back().path.string());
    return Done{};
}

Status compare_verb(CompareArguments arguments) {
    CompareJob& job = arguments.job;
    if (arguments.table != Table::codecs)
        job.recipe = arguments.table == Table::published ? Recipe::published : Recipe::updated;
    job.options.pictures = !arguments.json_only;
    job.options.convergence = !arguments.json_only && !arguments.no_convergence;

    // Check names before files, so that errors come early.
    if (auto status = check(job); !status) return status;
    const auto environment = load(arguments.environment);
    if (!environment) return environment.error();
    if (auto status = check_folder(arguments.out); !status) return status;
    const auto comparison = compare(environment->image, job, progress_bar());
    if (!comparison) return comparison.error();
    return write_report(arguments, *comparison, environment->info);
}

}  // namespace

Verb add_compare(CLI::App& app) {
    auto a = std::make_shared<CompareArguments>();
    CLI::App* command =
        app.add_subcommand("compare", "Run codecs on an environment; write report.html and report.json");
    add_environment_options(*command, a->environment);
    add_sampling_options(*command, a->job.options.sampling);
    add_out_option(*command, a->out, "Folder of the report");
    CodecFilter& filter = a->job.codecs;
    CLI::Option* codec = command->add_option("--codec", filter.codecs,
                                             "Codecs to compare, as basis/encoder/evaluator (default: all listed)");
    CLI::Option* basis = command->add_option("--basis", filter.bases,
                                             "Bases to compare; they need not be listed (see lobelia list --axes)");
    CLI::Option* encoder = command->add_option("--encoder", filter.encoders, "Encoders to compare");
    CLI::Option* evaluator = command->add_option("--evaluator", filter.evaluators, "Evaluators to compare");
    for (CLI::Option* named : {codec, basis}) named->transform(CLI::Validator(replace_lobe_file, ""));
    for (CLI::Option* option : {basis, encoder, evaluator}) codec->excludes(option);
    CLI::Option* storage =
        command->add_option("--storage", a->job.storages,
                            "Storages to measure as well; all: every compatible one (see lobelia list --axes)");
    add_enum_option<Table>(
        *command, "--recipe", a->table, {{"published", Table::published}, {"updated", Table::updated}},
        "Reproduce a published table instead: published (2018, first version) or updated (2018, corrected)")
        ->default_str("")
        ->excludes(codec, basis, encoder, evaluator, storage, command->get_option("--sequence"),
                   command->get_option("--samples"), command->get_option("--seed"));
    command->add_flag("--json-only", a->json_only, "Write report.json only, without pictures and convergence");
    command->add_flag("--no-convergence", a->no_convergence, "Leave out the convergence plots");
    return {command, [a] { return compare_verb(*a); }};
}

}  // namespace lobelia::cli
