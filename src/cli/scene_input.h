// The scene argument that bake, render and others share: an embedded scene or a file, and the light around it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/read_image.h"
#include "scene/gltf_read.h"

namespace CLI {
class App;
}

namespace lobelia::cli {

struct SceneOptions {
    std::string path;                        ///< a .glb or .gltf file, or the name of an embedded scene
    std::optional<std::string> environment;  ///< a file, "sky" or "none"; nothing: what the scene brings
    ReadOptions read;                        ///< of the environment's file
    std::size_t uv_set = 1;                  ///< which TEXCOORD_n of a file holds the lightmap UVs
    bool photometric = false;                ///< a file's lights and emission are in candela, lux and nits
    std::optional<double> sun_elevation;     ///< of the sky [degrees]; any of these three asks for the sky
    std::optional<double> sun_azimuth;       ///< [degrees]
    std::optional<double> turbidity;
};

/// Whether the command can do without SCENE.
enum class SceneArgument { required, optional };

/// Adds the argument SCENE and all options.
void add_scene_options(CLI::App& command, SceneOptions& options, SceneArgument argument = SceneArgument::required);

/// Calls field(name, value) for each of the options, const or not, so that they can be written down and read again.
template <class Field, class Options>
void visit_scene_fields(Field& field, Options& options) {
    field("scene", options.path);
    field("environment", options.environment);
    field("ldr", options.read.ldr);
    field("sanitize", options.read.sanitize);
    field("uv_set", options.uv_set);
    field("photometric", options.photometric);
    field("sun_elevation", options.sun_elevation);
    field("sun_azimuth", options.sun_azimuth);
    field("turbidity", options.turbidity);
}

/// Makes or reads the scene and sets its environment; it has passed check_scene. Warnings are returned, not printed.
[[nodiscard]] Result<LoadedScene> load_scene(const SceneOptions& options);

/// The same, where at least one object has lightmap UVs.
[[nodiscard]] Result<LoadedScene> load_scene_to_bake(const SceneOptions& options);

/// Sets the environment as the options say; warnings are added to `scene`.
[[nodiscard]] Status set_environment(LoadedScene& scene, const SceneOptions& options);

}  // namespace lobelia::cli
