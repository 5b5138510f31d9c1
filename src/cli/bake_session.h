// A bake as lobelia bake and lobelia merge run it: progress, warnings, Ctrl-C, summary, report.
#pragma once

#include "cli/interrupt.h"
#include "lobelia/bake.h"
#include "lobelia/scene_source.h"

namespace lobelia::cli {

/// A session in the folder `out`, with a progress line and warnings on stderr. Holds the folder's lock, so that what a
/// verb reads there is still true when it writes; an error if another process holds it.
[[nodiscard]] Result<BakeSession> session_in(const std::string& out);

/// Loads the scene for a session that `stop` ends, with the reader's warnings. After Ctrl-C, unlocks the folder and
/// ends the program as the signal would.
[[nodiscard]] Result<LoadedScene> load_scene_in(BakeSession& session, const SceneSource& source,
                                                const StopOnInterrupt& stop);

/// Prints what came out of the job, and writes the report of a whole bake. After Ctrl-C, says how to continue, unlocks
/// the folder and ends the program as the signal would.
[[nodiscard]] Status finish_session(const Scene& scene, const BakeJob& job, const Result<Bake>& baked,
                                    BakeSession& session);

}  // namespace lobelia::cli
