// The scene argument that bake, render and others share.
#include "cli/scene_input.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <thread>

#include "cli/common.h"
#include "cli/options.h"
#include "scene/check_scene.h"
#include "scene/embedded.h"
#include "scene/sky_light.h"

namespace lobelia::cli {

namespace {

void add_light_options(CLI::App& command, SceneOptions& options) {
    command.add_option("--env", options.environment,
                       "The light around the scene: a latitude-longitude .hdr or .exr, \"sky\" for the embedded sky "
                       "and its sun, which replaces directional lights, or \"none\" (default: what the scene brings)");
    command.add_flag("--ldr", options.read.ldr,
                     "Accept PNG, JPEG and BMP as --env, too (decoded from sRGB; highlights are cut off)");
    command.add_flag("--sanitize", options.read.sanitize,
                     "Replace NaN, infinite and negative texels of --env by 0 where they are otherwise refused");
    command.add_option("--sun-elevation", options.sun_elevation, "Of the embedded sky [degrees] (default: 40)")
        ->check(number_in(1, 90));
    command.add_option("--sun-azimuth", options.sun_azimuth, "From -z towards +x [degrees] (default: 45)")
        ->check(number_in(-360, 360));
    command.add_option("--turbidity", options.turbidity, "Haze of the embedded sky (default: 3)")
        ->check(number_in(2, 10));
}

}  // namespace

void add_scene_options(CLI::App& command, SceneOptions& options, SceneArgument argument) {
    command
        .add_option(
            "SCENE", options.path,
            fmt::format("A .glb or .gltf file, or an embedded scene: {}", fmt::join(embedded_scene_names(), ", ")))
        ->required(argument == SceneArgument::required);
    command.add_option("--uv-set", options.uv_set, "Which TEXCOORD of a file holds the lightmap UVs")
        ->check(CLI::Range(0, 7))
        ->capture_default_str();
    command.add_flag("--photometric", options.photometric,
                     "Take a file's lights and emission as lux, candela and nits, 179 lm/W (default: as watts)");
    add_light_options(command, options);
}

namespace {

Result<LoadedScene> read_or_make(const SceneOptions& options) {
    // A name of the list is an embedded scene, unless there is a file of that name.
    std::error_code code;
    const auto names = embedded_scene_names();
    auto scene = embedded_scene(options.path);
    if (scene && !std::filesystem::is_regular_file(options.path, code)) {
        return LoadedScene{*std::move(scene), {}};
    }
    if (std::filesystem::exists(options.path, code)) {
        GltfReadOptions read;
        read.uv_set = options.uv_set;
        if (options.photometric) read.units = GltfReadOptions::Units::photometric;
        return read_gltf(options.path, read);
    }
    return Error{
        fmt::format("{}: no such file, and no embedded scene (known: {})", options.path, fmt::join(names, ", "))};
}

Status set_file_environment(LoadedScene& scene, const std::string& path, const ReadOptions& read) {
    allow_reader_threads(static_cast<int>(std::thread::hardware_concurrency()));
    auto loaded = read_environment(path, read);
    if (!loaded) return loaded.error();
    for (const auto& warning : loaded->warnings) scene.warnings.push_back(path + ": " + warning);
    if (loaded->sanitized.total() > 0)
        scene.warnings.push_back(
            fmt::format("{}: {} texels were no radiance and became 0", path, loaded->sanitized.total()));
    scene.scene.environment = std::move(loaded->image);
    return Done{};
}

}  // namespace

Status set_environment(LoadedScene& scene, const SceneOptions& options) {
    const bool has_sun = options.sun_elevation || options.sun_azimuth || options.turbidity;
    if (has_sun && options.environment && *options.environment != "sky")
        return Error{"--sun-elevation, --sun-azimuth and --turbidity belong to the embedded sky: use --env sky"};
    if (!options.environment && !has_sun) return Done{};
    if (!options.environment || *options.environment == "sky") {
        SkyOptions sky;
        sky.sun_elevation = options.sun_elevation.value_or(sky.sun_elevation);
        sky.sun_azimuth = options.sun_azimuth.value_or(sky.sun_azimuth);
        sky.turbidity = options.turbidity.value_or(sky.turbidity);
        if (const auto status = check(sky); !status) return status.error();
        set_sky(scene.scene, sky);
        return Done{};
    }
    if (*options.environment != "none") return set_file_environment(scene, *options.environment, options.read);
    scene.scene.environment.reset();
    return Done{};
}

Result<LoadedScene> load_scene(const SceneOptions& options) {
    auto scene = read_or_make(options);
    if (!scene) return scene.error();
    if (const auto status = set_environment(*scene, options); !status) return status.error();
    if (const auto status = check_scene(scene->scene); !status)
        return Error{options.path + ": " + status.error().message};
    return scene;
}

Result<LoadedScene> load_scene_to_bake(const SceneOptions& options) {
    auto loaded = load_scene(options);
    if (!loaded) return loaded;
    const auto& meshes = loaded->scene.meshes;
    if (std::all_of(meshes.begin(), meshes.end(), [](const Mesh& mesh) { return mesh.lightmap_uv.empty(); }))
        return Error{
            fmt::format("{}: no object has lightmap UVs (TEXCOORD_{}); lobelia unwrap {} -o OUT.glb makes them",
                        options.path, options.uv_set, options.path)};
    return loaded;
}

}  // namespace lobelia::cli
