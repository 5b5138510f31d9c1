// lobelia render: a scene by paths, or as a bake shows it, from one of its cameras.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "bake/render/render.h"
#include "bake/write/bake_folder.h"
#include "bake/write/scene_copy.h"
#include "cli/bake_input.h"
#include "cli/camera.h"
#include "cli/common.h"
#include "cli/options.h"
#include "cli/scene_input.h"
#include "cli/verbs.h"
#include "io/write_image.h"
#include "scene/scene_hash.h"

namespace lobelia::cli {
namespace {

namespace fs = std::filesystem;

struct RenderArguments {
    SceneOptions scene;
    std::string camera = "0", size = "960x600", out;
    PathOptions paths;
    RenderOptions render;
    std::optional<double> exposure;
    std::string tone = "filmic";
    bool truth = false;
};

constexpr std::array k_tone_names{"clamp", "reinhard", "filmic"};

ToneCurve tone_of(const std::string& name) {
    return static_cast<ToneCurve>(std::find(k_tone_names.begin(), k_tone_names.end(), name) - k_tone_names.begin());
}

/// The picture as the file's name wants it.
Status write_picture(const RenderArguments& options, const Image& image) {
    if (fs::path(options.out).extension() == ".exr") return write_exr(options.out, image);
    double mean = 0;
    for (const Rgb& pixel : image.pixels) mean += static_cast<double>(luminance(pixel));
    mean /= static_cast<double>(image.pixels.size());
    // Without an exposure the mean luminance is a quarter of white, as on the pages.
    const double automatic = mean > 0 ? 0.25 / mean : 1;
    const double exposure = options.exposure ? std::exp2(*options.exposure) : automatic;
    return write_png(options.out, to_srgb(image, static_cast<float>(exposure), tone_of(options.tone)));
}

Result<Image> finished(std::optional<Image> image) {
    if (!image) return Error{"render: stopped"};
    return *std::move(image);
}

Result<Image> render_scene(const RenderArguments& options, const Scene& scene) {
    const auto camera = find_camera(scene, options.camera);
    if (!camera) return camera.error();
    const World world = make_world(scene);
    PathOptions paths = options.paths;
    paths.bounces += 1;  // the surface that is seen counts for the tracer
    const PathTracer tracer(scene, world, paths);
    if (!tracer.has_light()) complain("lobelia: warning: " + scene.name + " has no light");
    return finished(render_paths(tracer, *camera, options.render));
}

Result<Image> render_baked(const RenderArguments& options) {
    const auto bake = read_bake(options.scene.path);
    if (!bake) return bake.error();
    const auto scene = load_scene_of_bake(options.scene, bake->manifest);
    if (!scene) return scene.error();
    for (const auto& warning : scene->warnings) complain("lobelia: warning: " + warning);
    if (options.truth) {
        RenderArguments truth = options;
        truth.paths = bake->manifest.options.paths;
        return render_scene(truth, scene->scene);
    }
    if (scene->scene.objects.size() != bake->manifest.objects.size())
        return Error{fmt::format("{}: holds {} objects, but its scene {}", options.scene.path,
                                 bake->manifest.objects.size(), scene->scene.objects.size())};
    const auto camera = find_camera(scene->scene, options.camera);
    if (!camera) return camera.error();

    std::optional<Codec> codec;
    if (!bake->manifest.options.codec.empty()) {
        auto made = make_codec(bake->manifest.options.codec);
        if (!made) return made.error();
        codec = *std::move(made);
    }
    std::vector<AtlasPlacement> placements;
    for (std::size_t i = 0; i < bake->manifest.objects.size(); ++i)
        placements.push_back(bake->manifest.scene ? placement_in_copy(bake->manifest, i)
                                                  : bake->manifest.objects[i].placement);
    const bool tangent =
        codec && (codec->basis().domain() == Domain::hemisphere || bake->manifest.options.frame == Frame::tangent);
    const World world = make_world(scene->scene);
    PathOptions paths = bake->manifest.options.paths;
    paths.bounces += 1;
    const PathTracer tracer(scene->scene, world, paths);
    const BakedLight light{bake->pages, placements, bake->layout(), codec ? &*codec : nullptr, tangent};
    return finished(render_bake(tracer, light, *camera, options.render));
}

Status render_verb(const RenderArguments& given) {
    RenderArguments options = given;
    const auto size = parse_grid(options.size);
    if (!size) return Error{"--size: " + size.error().message};
    options.render.width = size->width;
    options.render.height = size->height;
    const auto extension = fs::path(options.out).extension();
    if (extension != ".exr" && extension != ".png")
        return Error{options.out + ": the picture's name must end in .exr or .png"};
    if (auto status = check_file(options.out); !status) return status;
    options.render.progress = progress_bar();

    if (is_bake(options.scene.path)) {
        const auto image = render_baked(options);
        return image ? write_picture(options, *image) : image.error();
    }
    const auto scene = load_scene(options.scene);
    if (!scene) return scene.error();
    for (const auto& warning : scene->warnings) complain("lobelia: warning: " + warning);
    const auto image = render_scene(options, scene->scene);
    return image ? write_picture(options, *image) : image.error();
}

}  // namespace

Verb add_render(CLI::App& app) {
    auto options = std::make_shared<RenderArguments>();
    CLI::App* command =
        app.add_subcommand("render", "A picture of a scene by path tracing, or of a bake by its lightmaps");
    add_scene_options(*command, options->scene);
    command->get_option("SCENE")->description("A scene, as for lobelia bake, or the folder that lobelia bake wrote");
    command
        ->add_option("--camera", options->camera,
                     "Name or number of one of the scene's, or \"px,py,pz,tx,ty,tz[,fov]\": from p towards t [m], "
                     "field of view from bottom to top [degrees]")
        ->capture_default_str();
    command->add_option("--size", options->size, "WxH")->capture_default_str();
    command->add_option("--samples", options->render.samples, "For each pixel, 1 to 65536")
        ->check(CLI::Range(1u, 65536u))
        ->capture_default_str();
    command
        ->add_option("--bounces", options->paths.bounces,
                     "Surfaces that light may meet before the one that is seen, 0 to 64; of a bake: its own")
        ->check(CLI::Range(0, 64))
        ->capture_default_str();
    command->add_option("--seed", options->paths.seed, "Of all sequences, 0 to 4294967295; of a bake: its own")
        ->capture_default_str();
    command->add_flag("--truth", options->truth, "The scene of a bake by path tracing, to hold the bake against");
    command->add_option("-t,--threads", options->render.threads, "0: all processors")
        ->check(CLI::Range(0u, 1024u))
        ->capture_default_str();
    command
        ->add_option("--exposure", options->exposure,
                     "Of .png pictures, radiance times 2^this [EV] (default: its mean becomes a quarter of white)")
        ->check(number_in(-32, 32));
    command->add_option("--tone", options->tone, "Of .png pictures: how what is brighter than white is shown")
        ->check(CLI::IsMember(std::vector<std::string>(k_tone_names.begin(), k_tone_names.end())))
        ->capture_default_str();
    command->add_option("-o,--out", options->out, "The file to write: .exr, linear, or .png")->required();
    return {command, [options] { return render_verb(*options); }};
}

}  // namespace lobelia::cli
