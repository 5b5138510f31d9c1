// The scene of a bake, from the bake's folder.
#include <fmt/format.h>

#include <algorithm>

#include "bake/write/manifest.h"
#include "scene/check_scene.h"
#include "scene/embedded.h"
#include "scene/scene_source.h"

namespace lobelia {

Result<LoadedScene> read_baked_scene(const std::filesystem::path& path, const Manifest& manifest,
                                     const SceneSource& light) {
    // File names of a manifest have no folders; only `light` may name files elsewhere.
    const std::filesystem::path folder = bake_folder(path);
    SceneSource source = light;
    source.uv_set = SceneSource().uv_set;
    auto links = InputOptions::Links::followed;
    if (!source.environment && manifest.environment) {
        source.environment = (folder / *manifest.environment).string();
        links = InputOptions::Links::refused;
    }
    if (manifest.scene) {
        source.path = (folder / *manifest.scene).string();
        return load_scene_copy(source, links);
    }

    // Without a copy, the scene's name may be that of an embedded scene, never that of a file.
    auto scene = embedded_scene(manifest.scene_name);
    if (!scene)
        return Error{fmt::format("{}: holds no copy of its scene \"{}\"; bake it again with a scene that glTF can hold",
                                 path.string(), manifest.scene_name)};
    LoadedScene loaded;
    loaded.scene = *std::move(scene);
    if (auto status = set_environment(loaded, source, links); !status) return status.error();
    return loaded;
}

}  // namespace lobelia
