// lobelia prefilter: reflection probes of environments and of places in scenes.
#include <fmt/format.h>

#include <algorithm>

#include "bake/render/render_around.h"
#include "cli/bake_input.h"
#include "cli/common.h"
#include "cli/environment_input.h"
#include "cli/interrupt.h"
#include "cli/numbers.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/scene_input.h"
#include "cli/verbs.h"
#include "lobelia/bake.h"
#include "measure/prefilter_files.h"
#include "scene/embedded.h"

namespace lobelia::cli {
namespace {

/// More than this share of a view inside of things is worth a warning, as for probes.
constexpr double k_many_back_faces = 0.25;

struct PrefilterArguments {
    EnvironmentOptions environment;
    std::string format = "rgba16f", convention = "gltf", at, out;
    PrefilterOptions options;
    std::uint32_t path_samples = 256;
    PathOptions paths;
};

/// An environment file or "sky", not a scene and not a bake.
bool is_scene(const std::string& path) {
    return is_bake(path) || path.ends_with(".glb") || path.ends_with(".gltf") ||
           static_cast<bool>(embedded_scene(path));
}

Result<Vec3> parse_place(const std::string& text) {
    const auto numbers = parse_numbers(text);
    if (!numbers || numbers->size() != 3) return Error{"--at: \"" + text + "\" is not a place x,y,z [m]"};
    return Vec3{(*numbers)[0], (*numbers)[1], (*numbers)[2]};
}

Result<Image> view_of_scene(const PrefilterArguments& arguments, const StopOnInterrupt& stop) {
    const auto place = parse_place(arguments.at);
    if (!place) return place.error();
    SceneSource source;
    source.path = arguments.environment.path;
    Result<LoadedScene> loaded = Error{""};
    if (is_bake(source.path)) {
        const auto bake = read_bake(source.path);
        if (!bake) return bake.error();
        loaded = read_baked_scene(source.path, bake->manifest);
    } else {
        loaded = load_scene(source);
    }
    if (!loaded) return loaded.error();
    for (const auto& warning : loaded->warnings) complain("lobelia: warning: " + warning);
    RenderOptions options;
    options.samples = arguments.path_samples;
    options.stop = &stop.flag();
    options.progress = progress_bar();
    auto view = render_around(loaded->scene, *place, {4 * arguments.options.size, 2 * arguments.options.size},
                              arguments.paths, options);
    if (!view) return ended(view.error(), stop);
    if (view->back_faces > k_many_back_faces)
        complain(
            fmt::format("lobelia: warning: --at {}: {:.0f} % of the view is the inside of things; is the place in a "
                        "wall?",
                        arguments.at, 100 * view->back_faces));
    return std::move(view->radiance);
}

Result<Image> radiance(const PrefilterArguments& arguments, const StopOnInterrupt& stop) {
    if (is_scene(arguments.environment.path)) {
        if (arguments.at.empty())
            return Error{arguments.environment.path + ": a scene needs --at x,y,z, the place of the reflection probe"};
        return view_of_scene(arguments, stop);
    }
    if (!arguments.at.empty()) return Error{"--at: " + arguments.environment.path + " is not a scene"};
    auto environment = load(arguments.environment);
    if (!environment) return environment.error();
    return std::move(environment->image);
}

Status prefilter_verb(const PrefilterArguments& given) {
    PrefilterArguments arguments = given;
    if (auto status = check_folder(arguments.out); !status) return status;
    const StopOnInterrupt stop;
    const auto image = radiance(arguments, stop);
    if (!image) return image.error();
    arguments.options.convention = static_cast<CubeConvention>(
        std::find(k_cube_convention_names.begin(), k_cube_convention_names.end(), arguments.convention) -
        k_cube_convention_names.begin());
    arguments.options.stop = &stop.flag();
    arguments.options.progress = progress_bar();
    const auto levels = prefilter(*image, arguments.options);
    if (!levels) return ended(levels.error(), stop);
    const PrefilterFiles about{arguments.environment.path, arguments.at, arguments.format, arguments.options};
    if (Status status = write_prefilter(arguments.out, *image, *levels, about); !status)
        return ended(status.error(), stop);
    for (const CubeLevel& level : *levels)
        print_line("{:4} x {:<4} roughness {:.3f}   error {:.4f} RMS", level.size, level.size, level.roughness,
                   level.error);
    print_line("{}/specular.ktx2", arguments.out);
    return Done{};
}

}  // namespace

Verb add_prefilter(CLI::App& app) {
    auto a = std::make_shared<PrefilterArguments>();
    CLI::App* command =
        app.add_subcommand("prefilter", "Prefilter an environment, or a scene's light at a place, by GGX");
    add_environment_options(*command, a->environment);
    command->get_option("ENV")->description("An environment, \"sky\", a scene as for lobelia bake, or a bake");
    command->add_option("--at", a->at, "Place of the reflection probe in a scene, x,y,z [m]");
    command->add_option("--size", a->options.size, "Side of a face of the largest level [texels], a power of two")
        ->check(CLI::Range(2u, 4096u))
        ->capture_default_str();
    command->add_option("--levels", a->options.levels, "Mip levels")->check(CLI::Range(2u, 13u))->capture_default_str();
    command->add_option("--samples", a->options.samples, "Samples of the reflection for each texel")
        ->check(CLI::Range(16u, 65536u))
        ->capture_default_str();
    command->add_option("--path-samples", a->path_samples, "Paths for each texel of a scene's light")
        ->check(CLI::Range(1u, 65536u))
        ->capture_default_str();
    command
        ->add_option("--bounces", a->paths.bounces, "Maximum number of surfaces between light source and what is seen")
        ->check(CLI::Range(0, 64))
        ->capture_default_str();
    command->add_option("--seed", a->paths.seed, "Random seed of the paths")->capture_default_str();
    command->add_option("--format", a->format, "Pixel format of the cube map")
        ->check(CLI::IsMember({"rgba16f", "rgba32f", "rgb9e5", "bc6h_unsigned"}))
        ->capture_default_str();
    command
        ->add_option("--convention", a->convention,
                     "gltf: level = roughness (levels - 1); filament: level = roughness (2 - roughness) (levels - 1); "
                     "three: as gltf, mirrored along x for CubeTexture")
        ->check(CLI::IsMember(std::vector<std::string>(k_cube_convention_names.begin(), k_cube_convention_names.end())))
        ->capture_default_str();
    add_out_option(*command, a->out, "Output folder")->required();
    return {command, [a] { return prefilter_verb(*a); }};
}

}  // namespace lobelia::cli
