// lobelia list: the bases, encoders and evaluators, or every codec.
#include <fmt/core.h>

#include "cli/verbs.h"
#include "lobelia/codec.h"

namespace lobelia::cli {
namespace {

void print_axes() {
    fmt::print("bases (one RGB coefficient per function)\n");
    for (const auto& name : basis_names())
        fmt::print("  {:<20} {}\n", name, make_basis(name).value()->description());
    fmt::print("  {:<20} {}\n", "sg<N>, sg<N>a", "any number of spherical Gaussians on the sphere; a: and an ambient lobe");
    fmt::print("  {:<20} {}\n", "sg<N>h", "hemispherical sets");
    fmt::print("  {:<20} {}\n", "sg:FILE, sgh:FILE", "lobes from a file, a line \"x y z sharpness\" each");
    fmt::print("encoders\n");
    for (const auto& name : encoder_names()) fmt::print("  {}\n", name);
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
    fmt::print("A codec is one of each, basis/encoder/evaluator; lobelia list --codecs prints all {}.\n",
               all_codecs().size());
}

}  // namespace

Verb add_list(CLI::App& app) {
    CLI::App* command = app.add_subcommand("list", "Print the bases, encoders, evaluators, or all codecs");
    auto codecs = std::make_shared<bool>(false);
    command->add_flag("--codecs", *codecs, "Every codec, a line each");
    return {command, [codecs]() -> Status {
                if (*codecs)
                    for (const auto& codec : all_codecs()) fmt::print("{}\n", codec.str());
                else
                    print_axes();
                return Done{};
            }};
}

}  // namespace lobelia::cli
