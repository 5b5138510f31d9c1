// The verbs of the command line. Each reads its options, makes one library call and writes what came out.
#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <functional>
#include <string>

#include "lobelia/result.h"

namespace lobelia::cli {

/// What a verb does once its options are read.
using Action = std::function<Status()>;

/// Each adds its subcommand to `app` and returns what to do when it is chosen.
struct Verb {
    CLI::App* command;
    Action action;
};

[[nodiscard]] Verb add_advise(CLI::App& app);
[[nodiscard]] Verb add_bake(CLI::App& app);
[[nodiscard]] Verb add_compare(CLI::App& app);
[[nodiscard]] Verb add_convert(CLI::App& app);
[[nodiscard]] Verb add_encode(CLI::App& app);
[[nodiscard]] Verb add_eval(CLI::App& app);
[[nodiscard]] Verb add_reference(CLI::App& app);
[[nodiscard]] Verb add_list(CLI::App& app);
[[nodiscard]] Verb add_merge(CLI::App& app);
[[nodiscard]] Verb add_render(CLI::App& app);
[[nodiscard]] Verb add_study(CLI::App& app);
[[nodiscard]] Verb add_scene(CLI::App& app);
[[nodiscard]] Verb add_unwrap(CLI::App& app);

/// All of them, in the order in which help shows them.
inline constexpr std::array k_verbs = {add_compare, add_advise, add_bake,   add_render, add_merge,
                                       add_scene,   add_unwrap, add_encode, add_eval,   add_reference,
                                       add_convert, add_list,   add_study};

}  // namespace lobelia::cli
