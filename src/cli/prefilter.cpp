// lobelia prefilter: reflection probes of environments and of places in scenes.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bake/render/render_around.h"
#include "bake/write/files_together.h"
#include "cli/bake_input.h"
#include "cli/common.h"
#include "cli/environment_input.h"
#include "cli/interrupt.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/scene_input.h"
#include "cli/verbs.h"
#include "coefficients/encode.h"
#include "io/json.h"
#include "io/texture/container.h"
#include "lobelia/bake.h"
#include "lobelia/pixel_format.h"
#include "measure/prefilter.h"
#include "scene/embedded.h"

namespace lobelia::cli {
namespace {

/// More than this share of a view inside of things is worth a warning, as for probes.
constexpr double k_many_back_faces = 0.25;
constexpr std::size_t k_table_size = 64;

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
    std::array<double, 3> p{};
    int end = 0;
    if (std::sscanf(text.c_str(), "%lf,%lf,%lf%n", &p[0], &p[1], &p[2], &end) != 3 ||
        static_cast<std::size_t>(end) != text.size() ||
        !std::all_of(p.begin(), p.end(), [](double v) { return std::abs(v) <= 1e15; }))
        return Error{"--at: \"" + text + "\" is not a place x,y,z [m]"};
    return Vec3{static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
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

/// The format of an option that is one of the list's.
PixelFormat format_of(const PrefilterArguments& arguments) {
    const auto formats = pixel_formats();
    return *std::find_if(formats.begin(), formats.end(),
                         [&](PixelFormat format) { return info(format).name == arguments.format; });
}

/// Bytes of a level in a pixel format, face after face.
std::vector<std::byte> packed(const CubeLevel& level, PixelFormat format, float scale) {
    std::vector<std::byte> bytes;
    const std::size_t texels = level.size * level.size;
    for (std::size_t face = 0; face < 6; ++face) {
        std::array<std::vector<float>, 4> planes;
        for (std::size_t k = 0; k < 4; ++k)
            for (std::size_t i = 0; i < texels; ++i)
                planes[k].push_back(k == 3 ? 1 : (&level.texels[face * texels + i].r)[k] / scale);
        std::vector<const float*> channels;
        for (std::size_t k = 0; k < info(format).channels; ++k) channels.push_back(planes[k].data());
        std::vector<std::byte> part(byte_size(format, level.size, level.size));
        encode_texels(format, level.size, level.size, channels, part);
        bytes.insert(bytes.end(), part.begin(), part.end());
    }
    return bytes;
}

Status add_cube(FilesTogether& files, const std::vector<CubeLevel>& levels, const PrefilterArguments& arguments,
                float scale) {
    const PixelFormat format = format_of(arguments);
    std::vector<std::vector<std::byte>> bytes;
    for (const CubeLevel& level : levels) bytes.push_back(packed(level, format, scale));
    TextureFile texture{format, levels.front().size, levels.front().size};
    texture.levels.assign(bytes.begin(), bytes.end());
    texture.faces = 6;
    texture.metadata = {{"lobelia.channels", "radiance, prefiltered by GGX"},
                        {"lobelia.convention", arguments.convention},
                        {"lobelia.scale", fmt::format("{}", scale)}};
    return files.add("specular.ktx2", [&](StagedFile& file) {
        return write_texture(*find_texture_container("ktx2").value(), file, texture);
    });
}

Status add_table(FilesTogether& files) {
    const auto table = split_sum_table(k_table_size);
    std::array<std::vector<float>, 2> planes;
    for (const auto& entry : table)
        for (std::size_t k = 0; k < 2; ++k) planes[k].push_back(entry[k]);
    const std::array<const float*, 2> channels = {planes[0].data(), planes[1].data()};
    std::vector<std::byte> bytes(byte_size(PixelFormat::rg16f, k_table_size, k_table_size));
    encode_texels(PixelFormat::rg16f, k_table_size, k_table_size, channels, bytes);
    TextureFile texture{PixelFormat::rg16f, k_table_size, k_table_size, {bytes}};
    texture.metadata = {{"lobelia.channels", "scale of F0\nbias"}};
    return files.add("split-sum.ktx2", [&](StagedFile& file) {
        return write_texture(*find_texture_container("ktx2").value(), file, texture);
    });
}

Status write_all(const PrefilterArguments& arguments, const Image& image, const std::vector<CubeLevel>& levels,
                 const StopOnInterrupt& stop) {
    auto files = FilesTogether::in(arguments.out, &stop.flag());
    if (!files) return files.error();
    float largest = 0;
    for (const CubeLevel& level : levels)
        for (const Rgb& texel : level.texels) largest = std::max({largest, texel.r, texel.g, texel.b});
    const float scale = storing_scale(format_of(arguments), largest);
    if (Status status = add_cube(*files, levels, arguments, scale); !status) return status;
    if (Status status = add_table(*files); !status) return status;
    const auto harmonics = encode(image, "sh2/moments/convolution");
    if (!harmonics) return harmonics.error();
    if (Status status = files->add_text("irradiance.json", to_text(*harmonics)); !status) return status;

    nlohmann::ordered_json described = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < levels.size(); ++i)
        described.push_back(
            {{"level", i}, {"size", levels[i].size}, {"roughness", levels[i].roughness}, {"error", levels[i].error}});
    const nlohmann::ordered_json document = {{"lobelia_prefilter", 1},
                                             {"source", arguments.environment.path},
                                             {"at", arguments.at},
                                             {"convention", arguments.convention},
                                             {"specular", "specular.ktx2"},
                                             {"format", arguments.format},
                                             {"scale", scale},
                                             {"split_sum", "split-sum.ktx2"},
                                             {"irradiance", "irradiance.json"},
                                             {"samples", arguments.options.samples},
                                             {"levels", std::move(described)}};
    if (Status status = files->add_text("prefilter.json", json_text(document, 1) + "\n"); !status) return status;
    return files->commit();
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
    if (Status status = write_all(arguments, *image, *levels, stop); !status) return ended(status.error(), stop);
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
