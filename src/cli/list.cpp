// lobelia list: every codec, or what codecs are made of.
#include <fmt/core.h>

#include "cli/verbs.h"
#include "lobelia/codec.h"
#include "report/bases_page.h"

namespace lobelia::cli {
namespace {

void print_axes() {
    fmt::print("bases (one RGB coefficient per function)\n");
    for (const auto& name : basis_names()) fmt::print("  {:<20} {}\n", name, make_basis(name).value()->description());
    for (const auto& [pattern, meaning] : basis_name_patterns()) fmt::print("  {:<20} {}\n", pattern, meaning);
    fmt::print("encoders\n");
    for (const auto& name : encoder_names()) fmt::print("  {}\n", name);
    fmt::print("encoders for study, not in the product\n");
    for (const auto& name : encoder_variant_names()) fmt::print("  {}\n", name);
    fmt::print("evaluators\n");
    std::vector<std::string> seen;
    for (const auto& name : basis_names()) {
        const auto basis = make_basis(name).value();
        for (const auto& evaluator : basis->evaluator_names()) {
            if (std::find(seen.begin(), seen.end(), evaluator) != seen.end()) continue;
            seen.push_back(evaluator);
            const auto accuracy = basis->evaluator(evaluator)->accuracy();
            fmt::print("  {:<20} {}: error at most {}\n", evaluator, accuracy.range, accuracy.error);
        }
    }
    fmt::print("A codec is one of each, basis/encoder/evaluator; lobelia list prints all {} of the sensible product.\n",
               all_codecs().size());
}

struct Options {
    bool axes = false, markdown = false;
};

}  // namespace

Verb add_list(CLI::App& app) {
    CLI::App* command = app.add_subcommand("list", "Print the codecs, or what they are made of");
    auto options = std::make_shared<Options>();
    CLI::Option* axes =
        command->add_flag("--axes", options->axes, "The bases, encoders and evaluators with what they are, instead");
    command->add_flag("--markdown", options->markdown, "The page of bases, docs/bases.md, instead")->excludes(axes);
    return {command, [options]() -> Status {
                if (options->axes)
                    print_axes();
                else if (options->markdown)
                    fmt::print("{}", bases_markdown());
                else
                    for (const auto& codec : all_codecs()) fmt::print("{}\n", codec.str());
                return Done{};
            }};
}

}  // namespace lobelia::cli
