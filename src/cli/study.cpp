// lobelia study: tables and graphs of how good formulae and encoders are.
#include "cli/verbs.h"

namespace lobelia::cli {
Verb add_study(CLI::App& app) {
    CLI::App* command = app.add_subcommand("study", "Measure formulae and encoders");
    return {command, []() -> Status { return Error{"nothing to study yet"}; }};
}
}  // namespace lobelia::cli
