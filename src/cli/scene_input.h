// The scene argument that bake, render and others share: an embedded scene or a file, and the light around it.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "io/read_image.h"
#include "lobelia/result.h"
#include "scene/scene.h"

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

/// Adds all options but the scene itself, which some verbs name otherwise.
void add_light_options(CLI::App& command, SceneOptions& options);
/// The same and the scene as the required argument SCENE.
void add_scene_options(CLI::App& command, SceneOptions& options);

struct LoadedScene {
    Scene scene;
    std::string name;  ///< for titles: of the file without its folder, or of the embedded scene
    std::vector<std::string> warnings;
};

/// Makes or reads the scene and sets its environment; it has passed check_scene. Warnings are returned, not printed.
[[nodiscard]] Result<LoadedScene> load_scene(const SceneOptions& options);

/// Sets the environment as the options say; warnings are added to `scene`.
[[nodiscard]] Status set_environment(LoadedScene& scene, const SceneOptions& options);

}  // namespace lobelia::cli
