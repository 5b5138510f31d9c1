// Reads and writes glTF 2.0 scenes (Khronos 2021). Reading is safe on any bytes.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lobelia/result.h"
#include "lobelia/scene.h"
#include "lobelia/scene_source.h"

namespace lobelia {

struct GltfReadOptions {
    /// TEXCOORD_<uv_set> holds the lightmap UVs.
    std::size_t uv_set = 1;
    /// radiometric: emission is W/(m^2 sr), point and spot lights W/sr, directional lights W/m^2. photometric: the
    /// units of the glTF specification, nit, candela and lux, which are divided by k_white_efficacy.
    enum class Units { radiometric, photometric } units = Units::radiometric;
    // Larger files are refused before memory is allocated for them.
    std::size_t most_bytes = std::size_t{1} << 33;      ///< of the file and all files that it refers to
    std::size_t most_triangles = std::size_t{1} << 27;  ///< of all meshes, and of all objects; three times the vertices
    std::size_t most_objects = std::size_t{1} << 22;
    std::size_t most_texels = std::size_t{1} << 28;  ///< of all textures
    /// Memory that the scene may take, with all its copies laid out in the world [bytes]. Absent: default_scene_memory
    /// of the file's size, so that a small file cannot ask for a large amount. Work is limited with it: at most one
    /// element is read for 8 bytes.
    std::optional<std::size_t> scene_memory = {};
    const std::atomic<bool>* stop = nullptr;  ///< ends the reading early, with an error, when it becomes true
};

/// Memory that a scene may take unless an option says otherwise: 1 GiB, and 256 times the size of its files [bytes].
[[nodiscard]] constexpr std::size_t default_scene_memory(std::size_t bytes_of_files) {
    return (std::size_t{1} << 30) + 256 * bytes_of_files;
}

/// Reads a .gltf or .glb file; the content, not the name, decides which. Buffers and images that it refers to must lie
/// in its folder or below. Errors name the file, the place in its JSON and the remedy.
///
/// Supported: the default scene with its visible nodes (KHR_node_visibility); instances by shared meshes and
/// EXT_mesh_gpu_instancing; triangles, strips and fans of every index and attribute type (KHR_mesh_quantization, sparse
/// accessors); skins and morph targets in their rest pose; metallic-roughness materials with alpha modes,
/// KHR_materials_emissive_strength, _unlit, _ior, _specular, KHR_texture_transform; PNG, JPEG and WebP textures
/// (EXT_texture_webp); KHR_lights_punctual; perspective cameras. Other content is left out with a warning; a required
/// extension that is not among these is an error.
///
/// Every object gets a name of its own: where nodes share one, the path of names ("house/door"), then a number. A scene
/// far from its origin is moved to it (Scene::origin), so that float positions keep their precision.
[[nodiscard]] Result<LoadedScene> read_gltf(const std::filesystem::path& path, const GltfReadOptions& options = {});

/// Returns the file at a relative path (without "..", percent signs decoded) of at most `most_bytes`, or an error.
using ResourceReader =
    std::function<Result<std::vector<std::byte>>(const std::string& relative_path, std::size_t most_bytes)>;

/// Reads a file in memory; messages call it `name`, and `resources` provides the files that it refers to (empty: none).
[[nodiscard]] Result<LoadedScene> read_gltf(std::span<const std::byte> bytes, std::string_view name,
                                            const ResourceReader& resources, const GltfReadOptions& options = {});

/// A lightmap for viewers that know nothing of Lobelia: the extension MOZ_lightmap of materials, texCoord 1.
struct GltfLightmap {
    std::string png;      ///< irradiance over pi and over `intensity`, in sRGB
    float intensity = 1;  ///< [W/m^2]
};

/// Additional content of the file. Vectors have an entry per object, or are empty.
struct GltfWriteOptions {
    /// Lightmap UVs that replace those of the object's mesh, one per vertex; empty: the mesh's own.
    std::vector<std::vector<Vec2>> lightmap_uv;
    std::string scene_extras;                    ///< a JSON object as text; empty: none
    std::vector<std::string> object_extras;      ///< likewise, for the objects' nodes
    std::string extensions;                      ///< of the file: a JSON object, contents by their extensions' names
    std::vector<std::string> object_extensions;  ///< likewise, of the objects' nodes
    std::vector<GltfLightmap> lightmaps = {};    ///< any number
    std::vector<std::optional<std::size_t>> object_lightmap = {};  ///< the one of `lightmaps` that an object has
};

/// Writes a .glb file into memory. read_gltf reads it as the same scene, up to the rounding of unit vectors and of
/// emission, with triangles sorted by material within a mesh, and without its environment, which glTF cannot store.
/// Lightmap UVs are TEXCOORD_1, texture coordinates TEXCOORD_0 and, for a second set that is not the lightmap's,
/// TEXCOORD_2; gaps between sets are filled; textures are PNG; a light's angular radius is in its extras.
/// Materials of objects with lightmaps are copied for each lightmap. The same scene gives the same bytes. Errors: more
/// than 4 GiB, extras that are not a JSON object, a texture transform that shears. Preconditions: check_scene; sizes as
/// stated above.
[[nodiscard]] Result<std::string> encode_glb(const Scene& scene, const GltfWriteOptions& options = {});

/// Writes the same bytes to a .glb file, which is replaced only once all of it is written.
[[nodiscard]] Status write_gltf(const std::filesystem::path& path, const Scene& scene,
                                const GltfWriteOptions& options = {});

}  // namespace lobelia
