// Bakes as arguments.
#include "cli/bake_input.h"

#include <filesystem>

namespace lobelia::cli {

namespace fs = std::filesystem;

bool is_bake(const std::string& path) {
    std::error_code code;
    return fs::is_directory(path, code) || fs::path(path).filename() == k_manifest_name;
}

Result<LoadedScene> load_scene_of_bake(const SceneOptions& options, const Manifest& manifest) {
    const fs::path folder = bake_folder(options.path);
    SceneOptions scene = options;
    scene.uv_set = SceneOptions().uv_set;
    scene.path = manifest.scene ? (folder / *manifest.scene).string() : manifest.scene_name;
    if (!scene.environment && manifest.environment) scene.environment = (folder / *manifest.environment).string();
    return load_scene(scene);
}

}  // namespace lobelia::cli
