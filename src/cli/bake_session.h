// A bake as lobelia bake and lobelia merge run it: progress, warnings, Ctrl-C, summary, report.
#pragma once

#include "cli/interrupt.h"
#include "lobelia/bake.h"

namespace lobelia::cli {

/// A session in the folder `out`, with a progress line and warnings on stderr.
[[nodiscard]] BakeSession session_in(const std::string& out, const StopOnInterrupt& stop);

/// Prints what came out of the job, and writes the report of a whole bake. After Ctrl-C, says how to continue and ends
/// the program as the signal would.
[[nodiscard]] Status finish_session(const Scene& scene, const BakeJob& job, const Result<Bake>& baked,
                                    const BakeSession& session);

}  // namespace lobelia::cli
