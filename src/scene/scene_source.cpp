// Loads scenes by name, with their environment.
#include "scene/scene_source.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <thread>

#include "io/read_image.h"
#include "lobelia/gltf.h"
#include "scene/check_scene.h"
#include "scene/embedded.h"
#include "scene/sky_light.h"

namespace lobelia {
namespace {

GltfReadOptions gltf_options(const SceneSource& source, const std::atomic<bool>* stop) {
    GltfReadOptions options;
    options.uv_set = source.uv_set;
    options.scene_memory = source.scene_memory;
    options.stop = stop;
    if (source.photometric == Switch::on) options.units = GltfReadOptions::Units::photometric;
    return options;
}

Result<LoadedScene> read_or_make(const SceneSource& source, const std::atomic<bool>* stop) {
    // A listed name is an embedded scene, unless a file of that name exists.
    std::error_code code;
    const auto names = embedded_scene_names();
    auto scene = embedded_scene(source.path);
    if (scene && !std::filesystem::is_regular_file(source.path, code)) {
        return LoadedScene{*std::move(scene)};
    }
    if (std::filesystem::exists(source.path, code)) return read_gltf(source.path, gltf_options(source, stop));
    return Error{fmt::format("{}: no such file, and no embedded scene (known: {}, terrain)", source.path,
                             fmt::join(names, ", "))};
}

Status set_file_environment(LoadedScene& scene, const std::string& path, const SceneSource& source) {
    allow_reader_threads(static_cast<int>(std::thread::hardware_concurrency()));
    auto loaded = read_environment(path, {.ldr = source.ldr == Switch::on, .sanitize = source.sanitize == Switch::on});
    if (!loaded) return loaded.error();
    for (const auto& warning : loaded->warnings) scene.warnings.push_back(path + ": " + warning);
    if (loaded->sanitized.total() > 0)
        scene.warnings.push_back(
            fmt::format("{}: {} NaN, infinite or negative texels replaced by 0", path, loaded->sanitized.total()));
    scene.scene.environment = std::move(loaded->image);
    return Done{};
}

}  // namespace

Status set_environment(LoadedScene& scene, const SceneSource& source) {
    const bool has_sun = source.sun_elevation || source.sun_azimuth || source.turbidity;
    if (has_sun && source.environment && *source.environment != "sky")
        return Error{"--sun-elevation, --sun-azimuth and --turbidity belong to the embedded sky: use --env sky"};
    if (!source.environment && !has_sun) return Done{};
    if (!source.environment || *source.environment == "sky") {
        SkyOptions sky;
        sky.sun_elevation = source.sun_elevation.value_or(sky.sun_elevation);
        sky.sun_azimuth = source.sun_azimuth.value_or(sky.sun_azimuth);
        sky.turbidity = source.turbidity.value_or(sky.turbidity);
        if (const auto status = check(sky); !status) return status.error();
        set_sky(scene.scene, sky);
        return Done{};
    }
    if (*source.environment != "none") return set_file_environment(scene, *source.environment, source);
    scene.scene.environment.reset();
    return Done{};
}

Result<LoadedScene> load_scene(const SceneSource& source, const std::atomic<bool>* stop) {
    auto scene = read_or_make(source, stop);
    if (!scene) return scene.error();
    if (const auto status = set_environment(*scene, source); !status) return status.error();
    if (const auto status = check_scene(scene->scene); !status)
        return Error{source.path + ": " + status.error().message};
    scene->source = source;
    return scene;
}

}  // namespace lobelia
