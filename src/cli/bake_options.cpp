// Options of lobelia bake, in groups.
#include "cli/bake_options.h"

#include "bake/check_job.h"
#include "bake/write/lightmap_exports.h"
#include "cli/common.h"
#include "cli/lobe_files.h"
#include "cli/options.h"
#include "cli/scene_input.h"
#include "io/texture/container.h"

namespace lobelia::cli {
namespace {

/// Checks a whole number.
template <class T>
CLI::Range whole_in(const OptionRange& range) {
    return {static_cast<T>(range.low), static_cast<T>(range.high)};
}
CLI::Validator number_in(const OptionRange& range) { return cli::number_in(range.low, range.high); }

/// Adds options to one group of the help.
class Group {
  public:
    Group(CLI::App& command, const char* name) : command_(command), name_(name) {}
    template <class T>
    CLI::Option* option(const char* names, T& value, const std::string& text) {
        return command_.add_option(names, value, text)->group(name_);
    }
    /// An option whose default is shown.
    template <class T>
    CLI::Option* with_default(const char* names, T& value, const char* text) {
        return option(names, value, text)->capture_default_str();
    }
    /// A choice of names.
    void choice(const char* names, std::string& value, std::vector<std::string> choices, const char* text) {
        with_default(names, value, text)->check(CLI::IsMember(std::move(choices)));
    }
    void flag(const char* names, bool& value, const char* text) { command_.add_flag(names, value, text)->group(name_); }

  private:
    CLI::App& command_;
    const char* name_;
};

void add_encoding_options(CLI::App& command, BakeArguments& a) {
    BakeOptions& bake = a.job.bake;
    Group group(command, "Encoding");
    group.with_default("--codec", bake.codec, "basis/encoder/evaluator, see lobelia list")
        ->transform(CLI::Validator(replace_lobe_file, ""));
    group.flag("--plain", a.plain, "Bake irradiance at the shading normal only, without a codec");
    group.choice("--frame", a.frame, {"world", "tangent"},
                 "Coordinate frame of spherical coefficients: world, or the tangent frame of each texel");
    group.choice("--directions", a.directions, {"uniform", "mixture"},
                 "Distribution of directions: uniform is best for radiance, mixture (half by the cosine) for "
                 "irradiance at the normal");
}

void add_transport_options(CLI::App& command, BakeArguments& a) {
    BakeOptions& bake = a.job.bake;
    Group group(command, "Light transport");
    group.with_default("--samples", bake.samples, "Samples per texel, rounded up to whole passes of 16")
        ->check(whole_in<unsigned>(ranges::samples));
    group
        .option("--target-error", bake.target_error,
                "Stop sampling a texel when its relative standard error is below this; --samples is the maximum")
        ->check(number_in(ranges::target_error));
    group.with_default("--bounces", bake.paths.bounces, "Maximum number of surfaces between light source and texel")
        ->check(whole_in<int>(ranges::bounces));
    group.with_default("--seed", bake.paths.seed, "Random seed");
    group.flag("--no-next-event", a.no_next_event, "Trace no shadow rays (slow; for comparison)");
    group.flag("--no-roulette", a.no_roulette, "Trace weak paths to the end (slow; for comparison)");
    group.flag("--no-push-out", a.no_push_out, "Do not move sample points out of overlapping geometry");
}

void add_page_options(CLI::App& command, BakeArguments& a) {
    AtlasOptions& atlas = a.job.bake.atlas;
    Group group(command, "Lightmap pages");
    group.with_default("--size", a.size, "Lightmap page size in texels, WxH, at most 16384x16384");
    group
        .option("--texels-per-metre", atlas.texels_per_metre,
                "Size each object by its area instead, and pack objects into pages")
        ->check(number_in(ranges::texels_per_metre));
    group.choice("--layout", a.layout, {"automatic", "shared", "packed"},
                 "shared: all objects lie in one UV square; packed: each object has its own");
    group.with_default("--padding", atlas.padding, "Texels between packed objects")
        ->check(whole_in<std::size_t>(ranges::padding));
    group.flag("--preflight", a.preflight, "Only check the lightmap UVs and estimate the cost; pictures go to --out");
}

void add_finish_options(CLI::App& command, BakeArguments& a) {
    Group group(command, "Finishing");
    group.flag("--no-denoise", a.no_denoise, "Do not denoise");
    group.flag("--no-seams", a.no_seams, "Do not close seams between charts");
    group.flag("--no-dilate", a.no_dilate, "Leave uncovered texels at 0");
}

void add_probe_options(CLI::App& command, BakeArguments& a) {
    Group group(command, "Probes");
    group.option("--probes", a.probe_box,
                 "Also bake probes, in the box of the \"scene\" or in one given by two corners, x,y,z,x,y,z [m]");
    group.option("--probe-spacing", a.probe_spacing, "Probe grid spacing in metres, coarsest level (default: 1)")
        ->check(number_in(ranges::probe_spacing));
    group.with_default("--probe-codec", a.probes.codec, "Codec for probes (must be spherical)")
        ->transform(CLI::Validator(replace_lobe_file, ""));
    group.with_default("--probe-levels", a.probes.levels, "Maximum number of subdivisions of a grid cell")
        ->check(whole_in<int>(ranges::probe_levels));
    group.with_default("--probe-samples", a.probes.samples, "Samples per probe")
        ->check(whole_in<unsigned>(ranges::probe_samples));
    group
        .with_default(
            "--probe-visibility", a.probes.visibility,
            "Side of each probe's octahedral map of distances [texels], which keeps light behind walls; 0: none")
        ->check(whole_in<unsigned>(ranges::probe_visibility));
}

void add_session_options(CLI::App& command, BakeArguments& a) {
    BakeOptions& bake = a.job.bake;
    Group group(command, "Sessions");
    group.with_default("-t,--threads", bake.threads, "Number of threads, 0: one per processor")
        ->check(whole_in<unsigned>(ranges::threads));
    group.with_default("--memory", a.memory, "Memory budget, such as 4G; larger bakes run region by region");
    group.option("--time", bake.most_seconds, "Stop after the first pass that exceeds this many seconds")
        ->check(number_in(ranges::seconds));
    group.flag("--resume", a.resume, "Continue the stopped bake or merge in --out with its options");
    group
        .option("--add-samples", a.add_samples,
                "Continue the finished bake in --out with this many more samples per texel")
        ->check(whole_in<unsigned>(ranges::samples));
    group.option("--rebake-object", a.rebake_object,
                 "Bake one object of the finished bake in --out again, in the scene as it is now; by name, or by "
                 "index as #3; the bake cannot be resumed afterwards");
    group.option("--shard", a.shard, "Bake one part of several, such as 0/4; lobelia merge puts them together");
    group.choice("--shard-by", a.shard_by, {"tiles", "samples"},
                 "tiles: the merged bake has the same bits as a whole one if all machines use one instruction set "
                 "(LOBELIA_SIMD); samples: up to rounding");
}

std::vector<std::string> container_names() {
    std::vector<std::string> names;
    for (const TextureContainer& container : texture_containers()) names.emplace_back(container.name);
    return names;
}

std::string export_list() {
    std::string list;
    for (const LightmapExport& entry : lightmap_exports())
        list += fmt::format("{}{}, {}", list.empty() ? "" : "; ", entry.name, entry.description);
    return list;
}

void add_output_options(CLI::App& command, BakeArguments& a) {
    Group group(command, "Output");
    group.option("-o,--out", a.out, "Output folder")->required();
    group.choice("--precision", a.precision, {"half", "float"}, "Format of the EXR pages");
    group
        .option("--storage", a.storages,
                "Write textures in this storage, see lobelia list --storages; repeatable; none: no textures "
                "(default: float16, and ratio8 where it is usable)")
        ->allow_extra_args(false);
    group.choice("--container", a.job.textures.container, container_names(), "File format of the textures");
    group.flag("--no-texture-arrays", a.no_arrays,
               "Write a file for each texture; otherwise those of one format and size are one array texture");
    group
        .with_default("--mip-levels", a.job.textures.levels,
                      "Mip levels of the textures, the page included; their sides must be multiples of 2^(levels - 1)")
        ->check(whole_in<unsigned>(ranges::mip_levels));
    group.flag("--zstd", a.zstd, "Compress the textures (KTX 2.0 supercompression scheme 2)");
    group
        .option("--export", a.exports,
                "Also write plain lightmaps for other programs: " + export_list() + "; repeatable")
        ->allow_extra_args(false);
    group.flag("--no-report,--no-page", a.no_report, "Do not make the HTML report");
    group.with_default("--picture-size", a.picture_size, "Size of the report's pictures, WxH");
    group.with_default("--picture-samples", a.job.report.samples, "Samples per pixel of the report's pictures")
        ->check(whole_in<unsigned>(ranges::picture_samples));
}

}  // namespace

void add_bake_options(CLI::App& command, BakeArguments& arguments) {
    add_scene_options(command, arguments.job.scene, SceneArgument::optional);
    add_output_options(command, arguments);
    add_encoding_options(command, arguments);
    add_transport_options(command, arguments);
    add_page_options(command, arguments);
    add_finish_options(command, arguments);
    add_probe_options(command, arguments);
    add_session_options(command, arguments);
}

}  // namespace lobelia::cli
