// The verbs of the command line. Each parses its options, makes one library call and prints the result.
#pragma once

#include <functional>

#include "lobelia/result.h"

namespace CLI {
class App;
}

namespace lobelia::cli {

/// A subcommand, and what runs after its options are parsed.
struct Verb {
    CLI::App* command;
    std::function<Status()> action;
};

/// THE list of verbs, in the order in which help shows them. To add a verb, write src/cli/NAME.cpp with add_NAME, which
/// adds its subcommand to `app`, and put its name here.
#define LOBELIA_VERBS(verb)                                                                                         \
    verb(compare) verb(advise) verb(bake) verb(render) verb(view) verb(merge) verb(scene) verb(unwrap) verb(encode) \
        verb(eval) verb(reference) verb(prefilter) verb(convert) verb(shader) verb(list) verb(study)

#define LOBELIA_DECLARE_VERB(name) [[nodiscard]] Verb add_##name(CLI::App& app);
LOBELIA_VERBS(LOBELIA_DECLARE_VERB)
#undef LOBELIA_DECLARE_VERB

}  // namespace lobelia::cli
