// The scene argument of bake, render and other verbs.
#include "cli/scene_input.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cli/common.h"
#include "cli/options.h"
#include "scene/embedded.h"

namespace lobelia::cli {

namespace {

/// Adds a flag that turns a switch on.
void add_switch(CLI::App& command, const char* name, Switch& value, const char* text) {
    command.add_flag_callback(
        name, [&value] { value = Switch::on; }, text);
}

void add_light_options(CLI::App& command, SceneSource& options) {
    command.add_option(
        "--env", options.environment,
        "Environment: a latitude-longitude .hdr or .exr, \"sky\" for the embedded sky and its sun, which "
        "replaces directional lights, or \"none\" (default: the scene's own)");
    add_switch(command, "--ldr", options.ldr,
               "Also accept PNG, JPEG and WebP as --env (decoded from sRGB; highlights are clipped)");
    add_switch(command, "--sanitize", options.sanitize,
               "Replace NaN, infinite and negative texels of --env by 0; they are refused otherwise");
    command
        .add_option("--sun-elevation", options.sun_elevation,
                    "Sun elevation of the embedded sky [degrees] (default: 40)")
        ->check(number_in(1, 90));
    command.add_option("--sun-azimuth", options.sun_azimuth, "Sun azimuth, from -z towards +x [degrees] (default: 45)")
        ->check(number_in(-360, 360));
    command.add_option("--turbidity", options.turbidity, "Haze of the embedded sky (default: 3)")
        ->check(number_in(2, 10));
}

}  // namespace

void add_scene_options(CLI::App& command, SceneSource& options, SceneArgument argument) {
    command
        .add_option(
            "SCENE", options.path,
            fmt::format("A .glb or .gltf file, or an embedded scene: {}", fmt::join(embedded_scene_names(), ", ")))
        ->required(argument == SceneArgument::required);
    command.add_option("--uv-set", options.uv_set, "Index n of TEXCOORD_n that holds the lightmap UVs of a file")
        ->check(CLI::Range(0, 7))
        ->capture_default_str();
    add_switch(command, "--photometric", options.photometric,
               "Lights and emission of the file are in lux, candela and nits, 179 lm/W (default: in watts)");
    command
        .add_option_function<std::string>(
            "--scene-memory",
            [&options](const std::string& text) {
                const auto bytes = parse_bytes("--scene-memory", text);
                if (!bytes) throw CLI::ValidationError(bytes.error().message);
                options.scene_memory = *bytes;
            },
            "Memory that the scene of a file may take, such as 8G, with all its copies laid out: a small file may ask "
            "for a large scene (default: 1G, and 256 times the size of the file)")
        ->type_name("BYTES");
    add_light_options(command, options);
}

Result<LoadedScene> load_scene_to_bake(const SceneSource& options, const std::atomic<bool>& stop) {
    auto loaded = load_scene(options, &stop);
    if (!loaded) return loaded;
    const auto& meshes = loaded->scene.meshes;
    if (!std::all_of(meshes.begin(), meshes.end(), [](const Mesh& mesh) { return mesh.lightmap_uv.empty(); }))
        return loaded;
    const auto& bare = loaded->parts_without_lightmap_uv;
    return Error{fmt::format("{}: no object has lightmap UVs (TEXCOORD_{}){}; lobelia unwrap {} -o OUT.glb makes them",
                             options.path, options.uv_set,
                             bare.empty() ? "" : fmt::format(" on all its parts: {} lacks them", fmt::join(bare, ", ")),
                             options.path)};
}

}  // namespace lobelia::cli
