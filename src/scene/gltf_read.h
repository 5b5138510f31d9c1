// Scenes from glTF 2.0 files (Khronos 2021), text or binary. Safe on any bytes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
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
    /// radiometric: emission is W/(m^2 sr), point and spot lights W/sr, directional lights W/m^2. photometric: as glTF
    /// says, nit, candela and lux; they are divided by k_white_efficacy.
    enum class Units { radiometric, photometric } units = Units::radiometric;
    // Larger files are refused before anything is allocated for what exceeds the limits.
    std::size_t most_bytes = std::size_t{1} << 33;      ///< of the file and all that it refers to
    std::size_t most_triangles = std::size_t{1} << 27;  ///< of all meshes, and of all objects; three times the vertices
    std::size_t most_objects = std::size_t{1} << 22;
    std::size_t most_texels = std::size_t{1} << 28;  ///< of all textures
};

/// Reads a .gltf or .glb file; the content, not the name, decides which. Buffers and images that it refers to must lie
/// in its folder or below. Errors name the file, the place in its JSON and what to do.
///
/// Read are: the file's default scene with all its nodes; instances by shared meshes and EXT_mesh_gpu_instancing;
/// triangles, strips and fans of every index and attribute type (KHR_mesh_quantization, sparse accessors); metallic-
/// roughness materials with alpha modes, KHR_materials_emissive_strength, _unlit, _ior, _specular,
/// KHR_texture_transform; KHR_lights_punctual; perspective cameras. Other content is left out, with a warning; a
/// required extension that is not among these is an error.
[[nodiscard]] Result<LoadedScene> read_gltf(const std::filesystem::path& path, const GltfReadOptions& options = {});

/// Gives the file at a relative path (no "..", percent signs decoded) of at most `most_bytes`, or an error.
using ResourceReader =
    std::function<Result<std::vector<std::byte>>(const std::string& relative_path, std::size_t most_bytes)>;

/// The same for a file that is in memory already; `name` is what messages call it, `resources` gives what it refers to
/// (empty: nothing).
[[nodiscard]] Result<LoadedScene> read_gltf(std::span<const std::byte> bytes, std::string_view name,
                                            const ResourceReader& resources, const GltfReadOptions& options = {});

}  // namespace lobelia
