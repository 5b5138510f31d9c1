// Scenes into binary glTF 2.0 files (Khronos 2021).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lobelia/result.h"
#include "lobelia/scene.h"

namespace lobelia {

/// What the file carries besides the scene. Vectors have an entry for each object, or are empty.
struct GltfWriteOptions {
    /// Lightmap UVs in place of those of the object's mesh: one for each vertex; empty: the mesh's own.
    std::vector<std::vector<Vec2>> lightmap_uv;
    std::string scene_extras;                ///< a JSON object as text; empty: none
    std::vector<std::string> object_extras;  ///< likewise, for the objects' nodes
};

/// The bytes of a .glb file that read_gltf reads as the same scene, up to the rounding of unit vectors and of emission,
/// with triangles sorted by material within a mesh, and without its environment, for which glTF has no place. Lightmap
/// UVs are TEXCOORD_1, texture coordinates TEXCOORD_0 and, of a second set that is not the lightmap's, TEXCOORD_2;
/// gaps between sets are filled; textures are PNG; a light's angular radius is in its extras. The same scene gives the
/// same bytes. Errors: more than 4 GiB, extras that are no JSON object, a texture transform that shears. Preconditions:
/// check_scene; sizes as said above.
[[nodiscard]] Result<std::string> encode_glb(const Scene& scene, const GltfWriteOptions& options = {});

/// The same into a file, written atomically.
[[nodiscard]] Status write_glb(const std::filesystem::path& path, const Scene& scene,
                               const GltfWriteOptions& options = {});

}  // namespace lobelia
