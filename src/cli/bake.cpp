// lobelia bake and lobelia merge: a scene in, lightmaps and probes out.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "cli/bake_job.h"
#include "cli/common.h"
#include "cli/options.h"
#include "cli/verbs.h"

namespace lobelia::cli {
namespace {

namespace fs = std::filesystem;

/// BakeArguments as they are typed, before they become a job.
struct BakeArguments {
    BakeJob job;
    std::string size = "512x512", memory = "2G", shard, shard_by = "tiles", frame = "world", directions = "uniform",
                layout = "automatic", probes;
    std::string precision = "half", rebake_object, picture_size = "640x400";
    std::vector<std::string> storages;
    std::uint32_t add_samples = 0;
    bool resume = false, plain = false, preflight = false;
    bool no_denoise = false, no_seams = false, no_dilate = false, no_push_out = false, no_page = false;
    bool no_next_event = false, no_roulette = false;
};

/// "4G", "512M" or a number of bytes.
Result<std::size_t> parse_memory(const std::string& text) {
    double value = 0;
    const char* end = text.data() + text.size();
    const auto [rest, code] = std::from_chars(text.data(), end, value);
    const std::string unit(rest, end);
    const double factor = unit.empty() ? 1 : unit == "M" ? 1 << 20 : unit == "G" ? 1 << 30 : 0;
    constexpr double least = 64 << 20, most = 1e15;
    if (code != std::errc() || factor == 0 || !(value * factor >= least) || !(value * factor <= most))
        return Error{"--memory: \"" + text + "\" is not an amount such as 512M or 4G (64M at least)"};
    return static_cast<std::size_t>(value * factor);
}

/// "0/4".
Result<Shard> parse_shard(const std::string& text, const std::string& by) {
    Shard shard;
    shard.by = by == "tiles" ? Shard::By::tiles : Shard::By::samples;
    if (text.empty()) return shard;
    const char* end = text.data() + text.size();
    const auto [slash, index_code] = std::from_chars(text.data(), end, shard.index);
    const bool good = index_code == std::errc() && slash != end && *slash == '/';
    const auto [rest, count_code] =
        good ? std::from_chars(slash + 1, end, shard.count) : std::from_chars_result{end, {}};
    if (!good || count_code != std::errc() || rest != end || shard.index >= shard.count || shard.count > 65536)
        return Error{"--shard: \"" + text + "\" is not a part such as 0/4, counted from 0"};
    return shard;
}

/// "scene", or two corners "x,y,z,x,y,z".
Result<std::optional<std::array<Vec3, 2>>> parse_box(const std::string& text) {
    if (text == "scene") return std::optional<std::array<Vec3, 2>>();
    std::array<float, 6> v{};
    const char *at = text.data(), *end = at + text.size();
    for (std::size_t i = 0; i < v.size(); ++i) {
        const auto [rest, code] = std::from_chars(at, end, v[i]);
        const bool last = i + 1 == v.size();
        if (code != std::errc() || !std::isfinite(v[i]) || (last ? rest != end : rest == end || *rest != ','))
            return Error{"--probes: \"" + text + "\" is neither \"scene\" nor two corners such as -1,0,-1,1,2,1"};
        at = rest + 1;
    }
    if (v[0] > v[3] || v[1] > v[4] || v[2] > v[5]) return Error{"--probes: the first corner must be the lower one"};
    return std::optional(std::array{Vec3{v[0], v[1], v[2]}, Vec3{v[3], v[4], v[5]}});
}

/// None for the default; "none" for an empty list.
Result<std::optional<std::vector<std::string>>> to_storages(const std::vector<std::string>& names) {
    if (names.empty()) return std::optional<std::vector<std::string>>();
    if (std::find(names.begin(), names.end(), "none") == names.end()) return std::optional(names);
    if (names.size() > 1) return Error{"--storage: \"none\" goes with no other"};
    return std::optional(std::vector<std::string>());
}

Switch off_if(bool flag) { return flag ? Switch::off : Switch::on; }

Result<BakeJob> to_job(const BakeArguments& options) {
    BakeJob job = options.job;
    const auto size = parse_grid(options.size);
    if (!size) return Error{"--size: " + size.error().message};
    if (size->width > 16384 || size->height > 16384)
        return Error{"--size: pages of at most 16384x16384 texels are made"};
    job.bake.atlas.width = size->width;
    job.bake.atlas.height = size->height;
    const auto memory = parse_memory(options.memory);
    if (!memory) return memory.error();
    job.bake.memory = *memory;
    const auto shard = parse_shard(options.shard, options.shard_by);
    if (!shard) return shard.error();
    job.bake.shard = *shard;
    job.bake.frame = options.frame == "world" ? Frame::world : Frame::tangent;
    job.bake.directions = options.directions == "uniform" ? DirectionChoice::uniform : DirectionChoice::mixture;
    using Layout = AtlasOptions::Layout;
    job.bake.atlas.layout = options.layout == "shared"   ? Layout::shared
                            : options.layout == "packed" ? Layout::packed
                                                         : Layout::automatic;
    const auto picture = parse_grid(options.picture_size);
    if (!picture || picture->width > 16384 || picture->height > 16384)
        return Error{"--picture-size: \"" + options.picture_size + "\" is not a size such as 640x400"};
    job.picture_width = picture->width;
    job.picture_height = picture->height;
    if (options.plain) job.bake.codec.clear();
    job.bake.push_out = off_if(options.no_push_out);
    job.bake.paths.next_event = off_if(options.no_next_event);
    job.bake.paths.roulette = off_if(options.no_roulette);
    job.finish = {off_if(options.no_denoise), off_if(options.no_seams), off_if(options.no_dilate)};
    job.page = !options.no_page;
    job.precision = options.precision == "half" ? ExrOptions::Precision::half : ExrOptions::Precision::full;
    auto storages = to_storages(options.storages);
    if (!storages) return storages.error();
    job.storages = std::move(*storages);
    if (!options.probes.empty()) {
        const auto box = parse_box(options.probes);
        if (!box) return box.error();
        job.probes.box = *box;
        if (!(job.probes.spacing > 0)) job.probes.spacing = 1;
    } else if (job.probes.spacing > 0) {
        return Error{"--probe-spacing goes with --probes"};
    }
    job.bake.checkpoint = checkpoint_folder(job.out);
    return job;
}

Status bake_verb(const BakeArguments& options) {
    const bool rebake = !options.rebake_object.empty();
    if (!options.resume && options.add_samples == 0 && !rebake) {
        if (options.job.scene.path.empty())
            return Error{"bake: a scene is missing: a .glb or .gltf file, or cornell or colonnade"};
        auto job = to_job(options);
        if (!job) return job.error();
        return options.preflight ? preflight_job(*job) : run_job(*job, JobStart::fresh);
    }

    // Everything but this session's limits is as it was.
    auto job = load_job(options.job.out);
    if (!job) return job.error();
    if (!options.job.scene.path.empty() && options.job.scene.path != job->scene.path)
        return Error{"bake: " + options.job.out.string() + " holds a bake of " + job->scene.path + ", not of " +
                     options.job.scene.path + "; the scene need not be repeated"};
    job->bake.threads = options.job.bake.threads;
    job->bake.most_seconds = options.job.bake.most_seconds;
    job->bake.samples += options.add_samples;
    if (!rebake) return run_job(*job, JobStart::resume);
    // States would no longer fit: the object, or what it sees, has changed.
    job->bake.only_object = options.rebake_object;
    job->bake.checkpoint.clear();
    return run_job(*job, JobStart::rebake);
}

Status merge_verb(const std::vector<std::string>& parts, const std::string& out, unsigned threads) {
    auto job = load_job(parts.front());
    if (!job) return job.error();
    std::vector<fs::path> folders;
    for (const auto& part : parts) folders.push_back(checkpoint_folder(part));
    job->out = out;
    job->bake.checkpoint = checkpoint_folder(out);
    job->bake.shard = {};
    job->bake.threads = threads;
    return run_job(*job, JobStart::merged, folders);
}

void add_transport_options(CLI::App& command, BakeArguments& o) {
    BakeOptions& bake = o.job.bake;
    command.add_option("--codec", bake.codec, "As basis/encoder/evaluator, see lobelia list")->capture_default_str();
    command.add_flag("--plain", o.plain, "No codec: irradiance at the shading normal alone");
    command.add_option("--frame", o.frame, "Where a basis over the sphere stands: world, or tangent to each texel")
        ->check(CLI::IsMember({"world", "tangent"}))
        ->capture_default_str();
    command.add_option("--samples", bake.samples, "For each texel, 1 to 1000000; rounded up to whole passes of 16")
        ->check(CLI::Range(1u, 1'000'000u))
        ->capture_default_str();
    command.add_option("--bounces", bake.paths.bounces, "Surfaces that light may meet on its way, 0 to 64")
        ->check(CLI::Range(0, 64))
        ->capture_default_str();
    command
        .add_option("--directions", o.directions,
                    "uniform: best for radiance; mixture: half by the cosine, for irradiance at the normal")
        ->check(CLI::IsMember({"uniform", "mixture"}))
        ->capture_default_str();
    command.add_option("--seed", bake.paths.seed, "Of all sequences, 0 to 4294967295")->capture_default_str();
    command.add_flag("--no-next-event", o.no_next_event, "Find light sources by chance only (slow; for comparison)");
    command.add_flag("--no-roulette", o.no_roulette, "Follow weak paths to the end (slow; for comparison)");
}

void add_atlas_options(CLI::App& command, BakeArguments& o) {
    AtlasOptions& atlas = o.job.bake.atlas;
    command.add_option("--size", o.size, "Of a page [texels], WxH, up to 16384x16384")->capture_default_str();
    command
        .add_option("--texels-per-metre", atlas.texels_per_metre,
                    "Size each object by its area instead, 0.01 to 10000; packs objects into pages")
        ->check(number_in(0.01, 10000));
    command.add_option("--layout", o.layout, "shared: objects lie in one UV square; packed: each has its own")
        ->check(CLI::IsMember({"automatic", "shared", "packed"}))
        ->capture_default_str();
    command.add_option("--padding", atlas.padding, "Texels between packed objects, 0 to 64")
        ->check(CLI::Range(std::size_t{0}, std::size_t{64}))
        ->capture_default_str();
}

void add_session_options(CLI::App& command, BakeArguments& o) {
    BakeOptions& bake = o.job.bake;
    command.add_option("-t,--threads", bake.threads, "0: all processors")
        ->check(CLI::Range(0u, 1024u))
        ->capture_default_str();
    command.add_option("--memory", o.memory, "For states and pages, as 512M or 4G; more than fits is baked in turn")
        ->capture_default_str();
    command.add_option("--time", bake.most_seconds, "End after the pass in which so many seconds are over, 0.1 to 1e7")
        ->check(number_in(0.1, 1e7));
    command
        .add_option("--target-error", bake.target_error,
                    "A texel is done when its relative standard error is below this, 1e-4 to 1; --samples at most")
        ->check(number_in(1e-4, 1));
    command.add_flag("--preflight", o.preflight,
                     "Only look at the lightmap UVs and at what the bake would take; pictures go to -o");
    command.add_flag("--resume", o.resume, "Go on with the bake in -o where it was stopped; its options are kept");
    command
        .add_option("--add-samples", o.add_samples,
                    "Go on with the bake in -o, with so many more samples, 1 to 1000000")
        ->check(CLI::Range(1u, 1'000'000u));
    command.add_option("--rebake-object", o.rebake_object,
                       "Bake this object of the finished bake in -o anew, from the scene as it is now");
    command.add_option("--shard", o.shard, "Only a part, such as 0/4; lobelia merge puts parts together");
    command.add_option("--shard-by", o.shard_by, "tiles: the merged bits are the same; samples: sums of them")
        ->check(CLI::IsMember({"tiles", "samples"}))
        ->capture_default_str();
}

void add_output_options(CLI::App& command, BakeArguments& o) {
    command.add_option("-o,--out", o.job.out, "Folder of the bake")->required();
    command.add_option("--precision", o.precision, "Of the EXR pages, half or float")
        ->check(CLI::IsMember({"half", "float"}))
        ->capture_default_str();
    command
        .add_option("--storage", o.storages,
                    "Write KTX2 textures in this storage, see lobelia list --storages; may be repeated; none: no "
                    "textures (default: float16, and ratio8 where it suits)")
        ->allow_extra_args(false);
    command.add_flag("--no-denoise", o.no_denoise, "Leave noise as it is");
    command.add_flag("--no-seams", o.no_seams, "Leave seams between charts as they are");
    command.add_flag("--no-dilate", o.no_dilate, "Leave texels that nothing covers at 0");
    command.add_flag("--no-push-out", o.no_push_out, "Leave texels under other surfaces where they are");
    command.add_flag("--no-page", o.no_page, "No bake.html and no pictures for it");
    command.add_option("--picture-size", o.picture_size, "Of the page's pictures from the scene's cameras, WxH")
        ->capture_default_str();
    command.add_option("--picture-samples", o.job.picture_samples, "Of each of their pixels, 1 to 65536")
        ->check(CLI::Range(1u, 65536u))
        ->capture_default_str();
    ProbeOptions& probes = o.job.probes;
    command.add_option("--probes", o.probes, "Bake probes, too: in the \"scene\"'s box or one given, x,y,z,x,y,z [m]");
    command.add_option("--probe-spacing", probes.spacing, "Of the coarsest grid [m], 0.001 to 10000 (default 1)")
        ->check(number_in(0.001, 10000));
    command.add_option("--probe-codec", probes.codec, "Over the sphere")->capture_default_str();
    command.add_option("--probe-levels", probes.levels, "How often a cell of the grid may be divided, 0 to 6")
        ->check(CLI::Range(0, 6))
        ->capture_default_str();
    command.add_option("--probe-samples", probes.samples, "For each probe, 64 to 1000000")
        ->check(CLI::Range(64u, 1'000'000u))
        ->capture_default_str();
}

}  // namespace

Verb add_bake(CLI::App& app) {
    auto options = std::make_shared<BakeArguments>();
    CLI::App* command = app.add_subcommand("bake", "Bake a scene's light into lightmaps and probes");
    add_scene_options(*command, options->job.scene, SceneArgument::optional);
    add_transport_options(*command, *options);
    add_atlas_options(*command, *options);
    add_session_options(*command, *options);
    add_output_options(*command, *options);
    return {command, [=]() { return bake_verb(*options); }};
}

Verb add_merge(CLI::App& app) {
    struct MergeOptions {
        std::vector<std::string> parts;
        std::string out;
        unsigned threads = 0;
    };
    auto options = std::make_shared<MergeOptions>();
    CLI::App* command = app.add_subcommand("merge", "Put the shards of a bake together");
    command->add_option("PART", options->parts, "Folders of shards, all of one bake")->required();
    command->add_option("-o,--out", options->out, "Folder of the whole bake")->required();
    command->add_option("-t,--threads", options->threads, "0: all processors")
        ->check(CLI::Range(0u, 1024u))
        ->capture_default_str();
    return {command, [=]() { return merge_verb(options->parts, options->out, options->threads); }};
}

}  // namespace lobelia::cli
