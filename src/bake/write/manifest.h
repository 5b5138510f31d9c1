// bake.json: the manifest as text. docs/bake-format.md describes the file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "bake/place/atlas.h"
#include "lobelia/bake.h"

namespace lobelia {

inline constexpr int k_bake_version = 3;
inline constexpr int k_oldest_bake_version = 2;  ///< the first one that is still read
inline constexpr const char* k_manifest_name = "bake.json";
inline constexpr const char* k_report_name = "bake.html";

/// Makes the manifest of a bake before its statistics and files are known.
[[nodiscard]] Manifest make_manifest(const Scene& scene, const Atlas& atlas, const BakeOptions& options);

/// The text of bake.json.
[[nodiscard]] std::string to_json_text(const Manifest& manifest);

/// What a renderer needs of bake.json, as the content of the glTF extension LOBELIA_lightmap (docs/bake-format.md).
[[nodiscard]] std::string lightmap_extension_text(const Manifest& manifest);

/// Checks everything: version, codec, counts, ranges, finite numbers, file names without folders, codec names without
/// files. Errors name the file, the place in it and the remedy.
[[nodiscard]] Result<Manifest> manifest_from_json(std::string_view text, const std::string& name);

/// Returns the folder of a bake: `path`, or the folder of the bake.json that `path` names.
[[nodiscard]] std::filesystem::path bake_folder(const std::filesystem::path& path);

/// Reads the bake.json in a folder, or the file itself.
[[nodiscard]] Result<Manifest> read_manifest(const std::filesystem::path& path);

/// The text of bake.json in a folder or at a path, and the path to name in messages.
struct ManifestText {
    std::string text, name;
};
[[nodiscard]] Result<ManifestText> read_manifest_text(const std::filesystem::path& path);

}  // namespace lobelia
