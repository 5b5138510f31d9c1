// The scene of a bake, from the bake's folder.
#include <fmt/format.h>

#include <algorithm>

#include "bake/write/bake_files.h"
#include "bake/write/manifest.h"
#include "scene/check_scene.h"
#include "scene/embedded.h"
#include "scene/scene_source.h"

namespace lobelia {

Result<LoadedScene> read_baked_scene(const std::filesystem::path& path, const Manifest& manifest,
                                     const SceneSource& light) {
    // File names of a manifest have no folders; only `light` may name files elsewhere.
    const auto folder = CommittedFolder::open(bake_folder(path));
    if (!folder) return folder.error();
    const BakeFiles files(*folder, manifest);
    SceneSource source = light;
    source.uv_set = SceneSource().uv_set;
    if (!source.environment && manifest.environment) {
        const auto environment = files.checked(*manifest.environment);
        if (!environment) return environment.error();
        source.environment = environment->string();
    }
    if (manifest.scene) {
        const auto copy = files.checked(*manifest.scene);
        if (!copy) return copy.error();
        source.path = copy->string();
        return load_scene(source);
    }

    // Without a copy, the scene's name may be that of an embedded scene, never that of a file.
    auto scene = embedded_scene(manifest.scene_name);
    if (!scene)
        return Error{fmt::format("{}: holds no copy of its scene \"{}\"; bake it again with a scene that glTF can hold",
                                 path.string(), manifest.scene_name)};
    LoadedScene loaded;
    loaded.scene = *std::move(scene);
    if (auto status = set_environment(loaded, source); !status) return status.error();
    return loaded;
}

}  // namespace lobelia
