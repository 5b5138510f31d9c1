// The bake: a scene in, lightmap pages and probes out, in one call or in several sessions.
//
//   BakeJob job;
//   job.bake.atlas = {.width = 256, .height = 256};
//   BakeSession session{.folder = "out"};
//   const Result<Bake> baked = bake(scene, job, session);
//
// docs/baking.md explains the options, docs/bake-format.md the folder.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lobelia/bake_job.h"
#include "lobelia/lightmap.h"
#include "lobelia/preflight.h"
#include "lobelia/texture_layout.h"

namespace lobelia {

struct BakeStatistics {
    std::size_t texels = 0;          ///< covered by triangles
    std::size_t invalid_texels = 0;  ///< validity below one half
    std::size_t buried_texels = 0;   ///< invalid texels under other surfaces, where no light can arrive
    std::uint64_t rays = 0;
    double seconds = 0;          ///< tracing and encoding, over all sessions
    std::uint32_t samples = 0;   ///< per texel, at most
    double mean_error = 0;       ///< RMS over texels of the standard error of E's luminance, over the mean of E
    double back_face_share = 0;  ///< leaks: fraction of paths of unburied texels that hit a back face first
    double negative_share = 0;   ///< fraction of the codec's irradiances around each normal that are negative
    double ringing = 0;          ///< mean of their negative parts, over their mean
    double codec_error = 0;      ///< RMS over texels of E by the codec minus E by the paths, over the mean of E
};

/// A texture of one page.
struct TextureEntry {
    std::string storage;                    ///< one of storages()
    std::string file;                       ///< in the bake's folder; its container is the extension
    TextureLayout::Texture layout;          ///< contents of its channels
    float scale = 1;                        ///< multiply stored values by this first
    std::optional<std::size_t> layer = {};  ///< of an array texture, which several entries share
};

/// The files of one page, in the bake's folder.
struct PageEntry {
    std::string file;                     ///< .exr
    std::vector<TextureEntry> textures;   ///< sorted by storage
    std::optional<std::string> validity;  ///< likewise, where there are textures
};

/// A file of the folder as it was written.
struct FileEntry {
    std::string file;
    std::uint64_t size = 0;   ///< [bytes]
    std::uint32_t crc32 = 0;  ///< as in zlib
};

/// An object of the scene and its place; in the scene's order, those without lightmap UVs included.
struct ObjectEntry {
    std::string name;
    AtlasPlacement placement;
};

/// The contents of bake.json.
struct Manifest {
    std::string program;  ///< version of the program that baked it
    std::string scene_name;
    std::uint64_t scene_hash = 0;            ///< scene_hash(scene)
    std::optional<std::string> scene;        ///< file of the glTF copy, whose lightmap UVs are those of the pages
    std::optional<std::string> environment;  ///< file of the scene's environment
    std::vector<std::string> warnings;
    std::size_t coefficients = 0;       ///< per texel; each is R, G, B
    std::size_t width = 0, height = 0;  ///< of each page [texels]
    Precision precision = Precision::full;
    std::vector<PageEntry> pages;  ///< filled in by write_bake
    std::vector<ObjectEntry> objects;
    std::optional<std::string> probes;  ///< file of the probes' description
    std::vector<FileEntry> files;       ///< all but bake.json; filled in by write_bake; empty in older bakes
    BakeOptions options;                ///< all but memory and threads
    std::vector<std::string> finish;    ///< steps taken, in order: denoise, seams, dilate
    BakeStatistics statistics;
};

/// A bake in memory. Evaluate a texel's coefficients with make_codec(manifest.options.codec).
struct Bake {
    Manifest manifest;
    std::vector<LightmapPage> pages;
    std::vector<std::vector<Vec3>> normals;  ///< shading normals of each page's texels; zero where nothing was baked
    std::optional<ProbeSet> probes;
    std::optional<Preflight> preflight;  ///< absent in a bake that was read from a folder

    [[nodiscard]] PageChannels channels() const { return {manifest.coefficients}; }
};

struct BakeProgress {
    enum class Stage { texels, probes } stage = Stage::texels;
    double done = 0;  ///< fraction of the stage, in [0, 1]
    double rays_per_second = 0;
    double seconds_left = 0;
    double error = 0;  ///< BakeStatistics::mean_error so far; 0: not known yet
    std::uint32_t pass = 0, passes = 0;
};

/// The right to write into a folder, which one process has at a time. Destroying it gives it back; so does the end of
/// the process, however it ends.
class FolderLock;

/// Locks a bake's folder, which is made if it is missing, completes there what a killed process left unfinished, and
/// removes its temporary files. An error that names the owner if the folder is locked; an error if the checkpoint there
/// is a symbolic link.
[[nodiscard]] Result<std::shared_ptr<const FolderLock>> lock_folder(const std::filesystem::path& folder);

/// One run of a job: where it keeps its states, how it is watched and stopped. Callbacks may come from any thread,
/// never concurrently.
struct BakeSession {
    /// Holds the checkpoint while the bake runs, and then the bake as write_bake leaves it. Empty: no files.
    std::filesystem::path folder;
    /// The folder's lock, for callers that read there what the run depends on. Absent: each run takes its own.
    std::shared_ptr<const FolderLock> lock = {};
    /// fresh: an error if the folder holds a checkpoint. resume: continue the checkpoint there, if there is one.
    enum class Start { fresh, resume } start = Start::fresh;
    const std::atomic<bool>* stop = nullptr;  ///< ends the run when it becomes true; the checkpoint stays
    std::function<void(const BakeProgress&)> progress = {};
    std::vector<std::string> earlier_warnings = {};     ///< of the scene's reader; go to `warn` and into the manifest
    std::function<void(const std::string&)> warn = {};  ///< receives each warning at once; the manifest keeps them, too
};

/// Bakes a scene: places texels on pages, gathers light for them, solves for coefficients, finishes the pages, writes
/// them into the session's folder. The same bits for any number of threads, regions, sessions and tile shards, on one
/// instruction set (simd.h); a mixture gives a warning. The bake of a shard (job.bake.shard.count > 1) has no pages:
/// its states lie in the session's folder for merge_bake. Preconditions: the scene passes check_scene. Errors name what
/// is wrong and the remedy: an option out of range, a folder in use; an early stop is an error. Resumed with more
/// samples than the job in the folder, it is an error if the states there do not hold all of that job's.
[[nodiscard]] Result<Bake> bake(const Scene& scene, const BakeJob& job, BakeSession& session);

/// Merges the checkpoints of all shards of a job, given by their bakes' folders, into the session's folder, and
/// finishes the bake there; if it is interrupted after the merging, bake() resumes it. Errors: the shards do not hold
/// each pass of the job exactly once (one is missing, unfinished or given twice), or are of another bake. Precondition:
/// job.bake.shard is that of a whole bake.
[[nodiscard]] Result<Bake> merge_bake(const Scene& scene, const BakeJob& job,
                                      std::span<const std::filesystem::path> shards, BakeSession& session);

/// Bakes the texels of one object again, in the scene as it is now, and replaces them in `there`, a finished bake of
/// the same job (an error otherwise). `object` is its name, or its index as "#3". The states in the session's folder
/// are removed, as they do not hold the new texels: nothing can be resumed there afterwards.
[[nodiscard]] Result<Bake> rebake_object(const Scene& scene, const BakeJob& job, std::string_view object, Bake there,
                                         BakeSession& session);

/// Returns the job that bake() keeps with its checkpoint in a bake's folder.
[[nodiscard]] Result<BakeJob> read_job(const std::filesystem::path& folder);

struct WriteBakeOptions {
    TextureOptions textures = {};
    const Scene* scene = nullptr;                          ///< also write a copy of the scene and its environment
    std::optional<std::vector<std::string>> exports = {};  ///< plain lightmaps besides, by name; absent: none
    const std::atomic<bool>* stop = nullptr;               ///< ends the writing early, with an error and no new file
};

/// Writes a folder: pages, textures, probes, bake.json; returns the manifest with the files' names and checksums. The
/// files take their places in one step for readers, even if the process is killed meanwhile; files of an older bake
/// there that this one does not have are removed. The folder is made if it is missing, and locked. Values that half
/// floats cannot hold are written as floats, with a warning in the manifest; values that are not finite are an error.
[[nodiscard]] Result<Manifest> write_bake(const std::filesystem::path& folder, const Bake& bake,
                                          const WriteBakeOptions& options = {});

/// Reads a folder, or the bake.json in it, and checks each file against its checksum. Opens no files outside the folder
/// and writes none. Errors name the file and the place in it.
[[nodiscard]] Result<Bake> read_bake(const std::filesystem::path& folder);

/// Reads the scene of a bake in a folder: the copy there, or the embedded scene that was baked. Render it with
/// LightmapUv::of_copy if manifest.scene is set. `light` may replace the environment.
[[nodiscard]] Result<LoadedScene> read_baked_scene(const std::filesystem::path& folder, const Manifest& manifest,
                                                   const SceneSource& light = {});

}  // namespace lobelia
