// Scenes by name, with their environment.
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
#include "scene/gltf/resources.h"
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
    // A name of the list is an embedded scene, unless there is a file of that name.
    std::error_code code;
    const auto names = embedded_scene_names();
    auto scene = embedded_scene(source.path);
    if (scene && !std::filesystem::is_regular_file(source.path, code)) {
        return LoadedScene{*std::move(scene), {}, {}};
    }
    if (std::filesystem::exists(source.path, code)) return read_gltf(source.path, gltf_options(source, stop));
    return Error{
        fmt::format("{}: no such file, and no embedded scene (known: {})", source.path, fmt::join(names, ", "))};
}

Status set_file_environment(LoadedScene& scene, const SceneSource& source, InputOptions::Links links) {
    const std::string& path = *source.environment;
    allow_reader_threads(static_cast<int>(std::thread::hardware_concurrency()));
    auto file = InputFile::open(path, {.links = links});
    if (!file) return file.error();
    auto loaded = read_environment(*std::move(file),
                                   {.ldr = source.ldr == Switch::on, .sanitize = source.sanitize == Switch::on});
    if (!loaded) return loaded.error();
    for (const auto& warning : loaded->warnings) scene.warnings.push_back(path + ": " + warning);
    if (loaded->sanitized.total() > 0)
        scene.warnings.push_back(
            fmt::format("{}: {} NaN, infinite or negative texels replaced by 0", path, loaded->sanitized.total()));
    scene.scene.environment = std::move(loaded->image);
    return Done{};
}

}  // namespace

Status set_environment(LoadedScene& scene, const SceneSource& source, InputOptions::Links links) {
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
    if (*source.environment != "none") return set_file_environment(scene, source, links);
    scene.scene.environment.reset();
    return Done{};
}

namespace {

Result<LoadedScene> with_environment(Result<LoadedScene> scene, const SceneSource& source, InputOptions::Links links) {
    if (!scene) return scene;
    if (const auto status = set_environment(*scene, source, links); !status) return status.error();
    if (const auto status = check_scene(scene->scene); !status)
        return Error{source.path + ": " + status.error().message};
    return scene;
}

}  // namespace

Result<LoadedScene> load_scene(const SceneSource& source, const std::atomic<bool>* stop) {
    return with_environment(read_or_make(source, stop), source, InputOptions::Links::followed);
}

Result<LoadedScene> load_scene_copy(const SceneSource& source, InputOptions::Links environment) {
    const GltfReadOptions options = gltf_options(source, nullptr);
    const auto file = InputFile::open(source.path, within_folder(options.most_bytes));
    if (!file) return file.error();
    const auto bytes = read_file(*file);
    if (!bytes) return bytes.error();
    const auto folder = std::filesystem::path(source.path).parent_path();
    return with_environment(read_gltf(*bytes, source.path, gltf::files_in(folder), options), source, environment);
}

}  // namespace lobelia
