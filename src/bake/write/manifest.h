// What a bake says of itself: bake.json. docs/bake-format.md describes the file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "bake/baker.h"
#include "bake/place/atlas.h"
#include "io/write_image.h"
#include "lobelia/texture_layout.h"

namespace lobelia {

/// An object of the scene and where it lies; in the scene's order, those without lightmap UVs included.
struct BakedObject {
    std::string name;
    AtlasPlacement placement;
};

/// A texture of one page.
struct BakedTexture {
    std::string storage;            ///< by its name: storages()
    std::string file;               ///< .ktx2, beside the manifest
    TextureLayout::Texture layout;  ///< what its channels hold
    float scale = 1;                ///< what was stored is to be multiplied by this first
};

struct BakedPage {
    std::string file;                     ///< .exr, beside the manifest
    std::vector<BakedTexture> textures;   ///< of one storage after the other
    std::optional<std::string> validity;  ///< .ktx2, where there are textures
};

struct Manifest {
    std::string program;                     ///< the version that wrote it
    std::string scene_name;                  ///< of the scene
    std::uint64_t scene_hash = 0;            ///< scene_hash(scene)
    std::optional<std::string> scene;        ///< the glTF copy, beside the manifest; its lightmap UVs are the pages'
    std::optional<std::string> environment;  ///< the image of the scene's environment, beside the manifest
    std::vector<std::string> warnings;       ///< what people should know of the bake
    std::size_t coefficients = 0;            ///< of each texel; each is R, G, B
    std::size_t width = 0, height = 0;       ///< of each page [texels]
    ExrOptions::Precision precision = ExrOptions::Precision::full;  ///< of the coefficients in the pages
    std::vector<BakedPage> pages;
    std::vector<BakedObject> objects;
    std::optional<std::string> probes;  ///< the probes' JSON file, beside the manifest
    BakeOptions options;                ///< codec and frame, too; memory, threads and checkpoint are not kept
    std::vector<std::string> finish;    ///< steps that were taken after the bake, in order: denoise, seams, dilate
    BakeStatistics statistics;
};

inline constexpr int k_bake_version = 2;
inline constexpr const char* k_manifest_name = "bake.json";

/// What is known before the pages are written: all but `scene`, `pages` and `probes`.
[[nodiscard]] Manifest make_manifest(const Scene& scene, const Atlas& atlas, const BakeOptions& options,
                                     const BakeStatistics& statistics);

/// The text of bake.json.
[[nodiscard]] std::string to_json_text(const Manifest& manifest);

/// Checks everything: version, codec, counts, ranges, finite numbers, file names without folders. Errors name the file,
/// the place in it and what to do.
[[nodiscard]] Result<Manifest> manifest_from_json(std::string_view text, const std::string& name);

/// The folder of a bake: `path`, or where the bake.json lies that it names.
[[nodiscard]] std::filesystem::path bake_folder(const std::filesystem::path& path);

/// bake.json in a folder, or the file itself.
[[nodiscard]] Result<Manifest> read_manifest(const std::filesystem::path& path);

}  // namespace lobelia
