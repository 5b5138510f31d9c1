// Which codecs and storages a comparison runs, by names, and the comparison itself as one call.
#pragma once

#include <string>
#include <vector>

#include "measure/comparison.h"
#include "measure/recipe.h"

namespace lobelia {

/// Chooses codecs by name. `codecs` are whole names and exclude the filters; without them, every listed codec whose
/// basis, encoder and evaluator pass the filters (an empty filter passes all). A basis named here need not be listed;
/// encoders for study run only if named.
struct CodecFilter {
    std::vector<std::string> codecs = {};
    std::vector<std::string> bases = {}, encoders = {}, evaluators = {};
};

/// The chosen codecs, each once. Error: an unknown name, or no codec matches.
[[nodiscard]] Result<std::vector<CodecName>> chosen_codecs(const CodecFilter& filter);

struct CompareJob {
    CodecFilter codecs = {};
    std::vector<std::string> storages = {};  ///< to store and measure in, too; "all": every compatible one
    std::optional<Recipe> recipe = {};       ///< reproduce this published table instead
    ComparisonOptions options = {};          ///< its storages are replaced by those named
};

/// Checks all names of a job before any file is read.
[[nodiscard]] Status check(const CompareJob& job);

/// Runs the job on an environment. Error: as check(), or a named storage is compatible with none of the codecs.
[[nodiscard]] Result<Comparison> compare(const Image& environment, const CompareJob& job,
                                         const Progress& progress = {});

}  // namespace lobelia
