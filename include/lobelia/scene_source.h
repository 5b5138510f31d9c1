// Scenes by name: a glTF file or an embedded scene, and the environment around it.
#pragma once

#include <atomic>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "lobelia/render.h"
#include "lobelia/result.h"
#include "lobelia/scene.h"

namespace lobelia {

/// The source of a scene, and how it is read.
struct SceneSource {
    std::string path;                             ///< a .glb or .gltf file, or the name of an embedded scene
    std::optional<std::string> environment = {};  ///< an image file, "sky" or "none"; absent: the scene's own
    Switch ldr = Switch::off;                     ///< accept 8-bit images as environment
    Switch sanitize = Switch::off;                ///< replace NaN, infinite and negative texels of the environment by 0
    std::size_t uv_set = 1;                       ///< lightmap UVs are the file's TEXCOORD_<uv_set>
    Switch photometric = Switch::off;             ///< lights and emission are in lux, candela and nits (179 lm/W)
    std::optional<double> sun_elevation = {};     ///< [degrees]; setting one of these three selects the embedded sky
    std::optional<double> sun_azimuth = {};       ///< from -z towards +x [degrees]
    std::optional<double> turbidity = {};         ///< haze
    std::optional<std::size_t> scene_memory = {};  ///< GltfReadOptions::scene_memory
};

/// A scene that passes check_scene, and the reader's warnings.
struct LoadedScene {
    Scene scene;
    std::vector<std::string> warnings = {};
    /// Primitives without lightmap UVs in meshes that have them elsewhere, by their places in the file.
    std::vector<std::string> parts_without_lightmap_uv = {};
    SceneSource source = {};  ///< of load_scene(); a job that keeps it can be resumed by the command line
};

/// Reads or makes the scene and sets its environment. Errors name the file, the place in it and the remedy; an early
/// stop, when `stop` becomes true, is an error too.
[[nodiscard]] Result<LoadedScene> load_scene(const SceneSource& source, const std::atomic<bool>* stop = nullptr);

}  // namespace lobelia
