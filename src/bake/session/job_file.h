// Jobs as files beside their checkpoints, so that a bake is resumed and merged without repeating its options.
#pragma once

#include <filesystem>

#include "lobelia/bake.h"

namespace lobelia {

inline constexpr const char* k_job_name = "checkpoint/job.json";  ///< in a bake's folder

/// A job, and what has become of its states.
struct KeptJob {
    BakeJob job;
    /// Objects of the finished bake that were baked again: no states hold their new texels, so there are none. Absent:
    /// none.
    std::optional<std::vector<std::string>> rebaked;
};

/// The text of job.json.
[[nodiscard]] std::string to_json_text(const KeptJob& kept);

/// Writes the job into the checkpoint of a bake's folder, for read_kept_job.
[[nodiscard]] Status save_job(const std::filesystem::path& folder, const BakeJob& job);

/// Reads the job of a bake's folder. An error for options that are unknown or out of range: a job that is not
/// understood completely would continue as another bake.
[[nodiscard]] Result<KeptJob> read_kept_job(const std::filesystem::path& folder);
[[nodiscard]] bool holds_job(const std::filesystem::path& folder);

/// An error unless the finished bake has the job's options, as far as they decide its texels.
[[nodiscard]] Status check_same_options(const Manifest& manifest, const BakeJob& job);

}  // namespace lobelia
