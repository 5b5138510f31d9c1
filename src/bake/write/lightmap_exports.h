// Plain lightmaps: irradiance as files that other programs read without knowing Lobelia.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bake/write/files_together.h"
#include "lobelia/bake.h"
#include "lobelia/gltf.h"

namespace lobelia {

struct LightmapExport {
    std::string_view name;  ///< also a part of its files' names
    std::string_view description;
    double factor;  ///< of irradiance [W/m^2]
    enum class Place { files, scene } place = Place::files;
};

/// THE list (src/bake/write/lightmap_exports.cpp).
[[nodiscard]] std::span<const LightmapExport> lightmap_exports();
/// Finds exports by name. Errors: an unknown name; the message lists the known ones.
[[nodiscard]] Result<std::vector<const LightmapExport*>> find_lightmap_exports(
    const std::optional<std::vector<std::string>>& names);

/// Makes the lightmaps of the pages that an export into the scene puts there; none if there is no such export.
[[nodiscard]] Result<std::vector<GltfLightmap>> lightmaps_in_scene(const Bake& bake,
                                                                   const std::vector<const LightmapExport*>& exports);

/// Writes the exports that are files: page-N.NAME.exr, with the channels R, G and B alone, and page-N.NAME.ktx2, BC6H
/// blocks, for each page: irradiance at the shading normals, dilated as the page is. Values that half floats cannot
/// hold are divided by a power of two in the texture, with a warning.
[[nodiscard]] Status add_exports(FilesTogether& files, const Bake& bake,
                                 const std::vector<const LightmapExport*>& exports, Manifest& manifest);

}  // namespace lobelia
