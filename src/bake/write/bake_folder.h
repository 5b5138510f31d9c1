// A bake as a folder: bake.json, its pages, probes and textures. docs/bake-format.md describes it.
#pragma once

#include "bake/probes/probes.h"
#include "bake/solve/pages.h"
#include "bake/write/manifest.h"

namespace lobelia {

/// All of a bake in memory.
struct Bake {
    Manifest manifest;
    std::vector<Page> pages;
    std::vector<std::vector<Vec3>> normals;  ///< of each page's texels: the shading normal, or zero where there is none
    std::optional<ProbeSet> probes;

    [[nodiscard]] PageLayout layout() const { return {manifest.coefficients}; }
};

struct WriteBakeOptions {
    /// Storages of the coefficients in textures, by name; absent: default_storages().
    std::optional<std::vector<std::string>> storages = {};
    /// What was baked: a glTF copy whose lightmap UVs are those of the pages, and its environment, are written, too.
    const Scene* scene = nullptr;
};

/// Writes the pages, their textures and the probes, then the manifest with the files' names filled in. The folder is
/// made if it is missing. Every file is complete beside its place before the first takes it; the manifest comes last.
[[nodiscard]] Status write_bake(const std::filesystem::path& folder, const Bake& bake,
                                const WriteBakeOptions& options = {});

/// Reads a folder, or the bake.json in it. Errors name the file and the place in it.
[[nodiscard]] Result<Bake> read_bake(const std::filesystem::path& folder);

}  // namespace lobelia
