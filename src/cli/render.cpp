// lobelia render: a picture of a scene by path tracing, or of a bake by its lightmaps.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "cli/bake_input.h"
#include "cli/camera.h"
#include "cli/common.h"
#include "cli/options.h"
#include "cli/scene_input.h"
#include "cli/verbs.h"
#include "io/write_image.h"
#include "lobelia/bake.h"

namespace lobelia::cli {
namespace {

struct RenderArguments {
    SceneSource scene;
    std::string camera = "0", size = "960x600", out;
    PathOptions paths;
    RenderOptions render;
    std::optional<double> exposure;
    std::string tone = "filmic";
    bool reference = false;
    std::string probes = "none";
};

constexpr std::array k_tone_names{"clamp", "reinhard", "filmic"};

ToneCurve tone_of(const std::string& name) {
    return static_cast<ToneCurve>(std::find(k_tone_names.begin(), k_tone_names.end(), name) - k_tone_names.begin());
}

/// Writes the picture in the format of the file's name.
Status write_picture(const RenderArguments& arguments, const Image& image) {
    if (auto status = check_finite(image); !status) return Error{arguments.out + ": " + status.error().message};
    if (std::filesystem::path(arguments.out).extension() == ".exr") return write_exr(arguments.out, image);
    double mean = 0;
    for (const Rgb& pixel : image.pixels) mean += static_cast<double>(luminance(pixel));
    mean /= static_cast<double>(image.pixels.size());
    // Without an exposure, map the mean luminance to a quarter of white, as the reports do.
    const double automatic = mean > 0 ? 0.25 / mean : 1;
    const double exposure = arguments.exposure ? std::exp2(*arguments.exposure) : automatic;
    return write_png(arguments.out, to_srgb(image, static_cast<float>(exposure), tone_of(arguments.tone)));
}

Result<Image> picture_of(const RenderArguments& arguments) {
    // Read the scene, and the bake if the argument is one.
    std::optional<Bake> bake;
    if (is_bake(arguments.scene.path)) {
        auto read = read_bake(arguments.scene.path);
        if (!read) return read.error();
        bake = *std::move(read);
    }
    const auto loaded =
        bake ? read_baked_scene(arguments.scene.path, bake->manifest, arguments.scene) : load_scene(arguments.scene);
    if (!loaded) return loaded.error();
    for (const auto& warning : loaded->warnings) complain("lobelia: warning: " + warning);

    // Render it.
    const Scene& scene = loaded->scene;
    const auto camera = find_camera(scene, arguments.camera);
    if (!camera) return camera.error();
    if (!bake && arguments.probes != "none") return Error{"--probes: " + arguments.scene.path + " is not a bake"};
    if (!bake) return render(scene, *camera, arguments.paths, arguments.render);
    if (arguments.reference) return render(scene, *camera, bake->manifest.options.paths, arguments.render);
    RenderOptions options = arguments.render;
    options.probes = arguments.probes == "none"  ? ProbeLight::none
                     : arguments.probes == "all" ? ProbeLight::all
                                                 : ProbeLight::unbaked;
    options.lightmap_uv = bake->manifest.scene ? LightmapUv::of_copy : LightmapUv::original;
    return render(scene, *bake, *camera, options);
}

Status render_verb(const RenderArguments& given) {
    RenderArguments arguments = given;
    const auto size = parse_grid(arguments.size);
    if (!size) return Error{"--size: " + size.error().message};
    arguments.render.width = size->width;
    arguments.render.height = size->height;
    const auto extension = std::filesystem::path(arguments.out).extension();
    if (extension != ".exr" && extension != ".png")
        return Error{arguments.out + ": the file name must end in .exr or .png"};
    if (auto status = check_file(arguments.out); !status) return status;
    arguments.render.progress = progress_bar();
    const auto image = picture_of(arguments);
    return image ? write_picture(arguments, *image) : image.error();
}

}  // namespace

Verb add_render(CLI::App& app) {
    auto arguments = std::make_shared<RenderArguments>();
    CLI::App* command = app.add_subcommand("render", "Render a scene by path tracing, or a bake by its lightmaps");
    add_scene_options(*command, arguments->scene);
    command->get_option("SCENE")->description("A scene, as for lobelia bake, or the folder that lobelia bake wrote");
    command
        ->add_option("--camera", arguments->camera,
                     "Name or number of one of the scene's cameras, or \"px,py,pz,tx,ty,tz[,fov]\": from p towards t "
                     "[m], vertical field of view [degrees]")
        ->capture_default_str();
    command->add_option("--size", arguments->size, "Picture size, WxH")->capture_default_str();
    command->add_option("--samples", arguments->render.samples, "Samples per pixel")
        ->check(CLI::Range(1u, 65536u))
        ->capture_default_str();
    command
        ->add_option("--bounces", arguments->paths.bounces,
                     "Maximum number of surfaces between light source and visible surface; a bake brings its own")
        ->check(CLI::Range(0, 64))
        ->capture_default_str();
    command->add_option("--seed", arguments->paths.seed, "Random seed; a bake brings its own")->capture_default_str();
    command->add_flag("--reference,--truth", arguments->reference, "Path-trace the bake's scene for comparison");
    command
        ->add_option("--probes", arguments->probes,
                     "Surfaces that the bake's probes light: none, those without a lightmap, or all")
        ->check(CLI::IsMember({"none", "unbaked", "all"}))
        ->capture_default_str();
    command->add_option("-t,--threads", arguments->render.threads, "Number of threads, 0: one per processor")
        ->check(CLI::Range(0u, 1024u))
        ->capture_default_str();
    command
        ->add_option(
            "--exposure", arguments->exposure,
            "Exposure of .png output [EV], radiance times 2^this (default: the mean becomes a quarter of white)")
        ->check(number_in(-32, 32));
    command->add_option("--tone", arguments->tone, "Tone curve for .png output")
        ->check(CLI::IsMember(std::vector<std::string>(k_tone_names.begin(), k_tone_names.end())))
        ->capture_default_str();
    command->add_option("-o,--out", arguments->out, "Output file: .exr, linear, or .png")->required();
    return {command, [arguments] { return render_verb(*arguments); }};
}

}  // namespace lobelia::cli
