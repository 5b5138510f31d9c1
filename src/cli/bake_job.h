// A whole bake as the command line asks for it: scene, bake, probes, finishing, output; kept beside the checkpoint, so
// that it can be resumed and merged without repeating the options.
#pragma once

#include <filesystem>

#include "bake/baker.h"
#include "bake/finish/finish.h"
#include "bake/probes/probe_bake.h"
#include "bake/session/preflight.h"
#include "bake/write/bake_folder.h"
#include "cli/scene_input.h"
#include "io/write_image.h"

namespace lobelia::cli {

struct FinishSteps {
    Switch denoise = Switch::on, seams = Switch::on, dilate = Switch::on;
};

struct BakeJob {
    SceneOptions scene;
    BakeOptions bake;
    FinishSteps finish;
    ProbeOptions probes;
    ExrOptions::Precision precision = ExrOptions::Precision::half;  ///< of the pages
    std::optional<std::vector<std::string>> storages;               ///< of their textures: WriteBakeOptions
    bool page = true;                                               ///< write the HTML page with its pictures
    std::uint32_t picture_samples = 64;                             ///< of each of their pixels
    std::size_t picture_width = 640, picture_height = 400;
    std::filesystem::path out;
};

/// Where a job keeps its states while it runs, and after for more samples.
[[nodiscard]] inline std::filesystem::path checkpoint_folder(const std::filesystem::path& out) {
    return out / "checkpoint";
}

/// Writes the job into its checkpoint folder, and reads it from there; `out` is the folder of the bake.
[[nodiscard]] Status save_job(const BakeJob& job);
[[nodiscard]] Result<BakeJob> load_job(const std::filesystem::path& out);

/// Where a job begins.
enum class JobStart {
    fresh,   ///< from nothing; a folder that holds states already is an error
    resume,  ///< where the states are
    merged,  ///< with the states of shards, put together
    rebake   ///< from nothing for one object of a finished bake
};

/// What is known of the lightmap UVs. Without a rate there is no estimate of the time.
[[nodiscard]] Preflight preflight_of(const Baker& baker, std::optional<TraceRate> rate = {});
/// bake.html; an error where `stop` was set while its pictures were made.
[[nodiscard]] Result<std::string> job_page(const BakeJob& job, const Scene& scene, const Baker& baker, const Bake& bake,
                                           const Preflight& checked, const std::atomic<bool>& stop);

/// Looks at the scene's lightmap UVs and at what the bake would take, before any ray; prints it and writes pictures.
[[nodiscard]] Status preflight_job(const BakeJob& job);

/// Loads, bakes, finishes, writes; progress on a terminal. Ctrl-C ends it with the last checkpoint in place.
[[nodiscard]] Status run_job(const BakeJob& job, JobStart start, std::span<const std::filesystem::path> shards = {});

}  // namespace lobelia::cli
