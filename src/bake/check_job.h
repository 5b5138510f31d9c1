// Ranges of a job's options, for callers that take them from elsewhere than the command line.
#pragma once

#include "lobelia/bake_job.h"

namespace lobelia {

/// An error that names the first option outside its range. bake() itself checks what depends on the scene or the codec.
[[nodiscard]] Status check(const BakeJob& job);

}  // namespace lobelia
