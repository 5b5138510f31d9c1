// lobelia list: every codec, or what codecs are made of.
#include <fmt/core.h>

#include "cli/verbs.h"
#include "lobelia/codec.h"
#include "lobelia/pack.h"

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
    fmt::print("storages\n");
    for (const Storage& storage : storages()) fmt::print("  {:<20} {}\n", storage.name, storage.description);
    fmt::print("A codec is one of each, basis/encoder/evaluator; lobelia list prints all {} of the sensible product.\n",
               all_codecs().size());
}

}  // namespace

Verb add_list(CLI::App& app) {
    CLI::App* command = app.add_subcommand("list", "Print the codecs, or what they are made of");
    auto axes = std::make_shared<bool>(false);
    command->add_flag("--axes", *axes, "The bases, encoders, evaluators and storages with what they are, instead");
    return {command, [axes]() -> Status {
                if (*axes)
                    print_axes();
                else
                    for (const auto& codec : all_codecs()) fmt::print("{}\n", codec.str());
                return Done{};
            }};
}

}  // namespace lobelia::cli
