// The baked scene as glTF, ready to be shown with its lightmaps.
#pragma once

#include <string>

#include "lobelia/bake.h"
#include "lobelia/gltf.h"

namespace lobelia {

/// The bytes of a .glb file. TEXCOORD_1 of each baked object is the uv on its page, so that the manifest's uv_scale and
/// uv_offset are not to be applied again; its node's extras name the page: {"lobelia_lightmap": {"page": 0, "file":
/// "page-0.exr"}}, the scene's the manifest. The extension LOBELIA_lightmap says what a renderer needs of the manifest,
/// whose pages have their textures by now. `lightmaps` are for other viewers: one for each page, or none. Errors as
/// encode_glb's.
[[nodiscard]] Result<std::string> encode_scene_copy(const Scene& scene, const Manifest& manifest,
                                                    std::vector<GltfLightmap> lightmaps = {});

/// Returns the placement of an object of the copy: texels of its page from the copy's own lightmap UVs.
[[nodiscard]] AtlasPlacement placement_in_copy(const Manifest& manifest, std::size_t object);

}  // namespace lobelia
