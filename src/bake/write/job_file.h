// Jobs as files beside their checkpoints, so that a bake is resumed and merged without repeating its options.
#pragma once

#include <filesystem>

#include "lobelia/bake.h"

namespace lobelia {

/// Writes the job into a checkpoint folder, for read_job.
[[nodiscard]] Status save_job(const std::filesystem::path& checkpoint, const BakeJob& job);

}  // namespace lobelia
