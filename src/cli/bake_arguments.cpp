// Converts the options of lobelia bake to its job.
#include <charconv>

#include "bake/check_job.h"
#include "cli/bake_options.h"
#include "cli/common.h"
#include "cli/numbers.h"

namespace lobelia::cli {
namespace {

/// Parses "0/4".
Result<Shard> parse_shard(const std::string& text, Shard::By by) {
    Shard shard{by};
    if (text.empty()) return shard;
    const char* end = text.data() + text.size();
    const auto [slash, index_code] = std::from_chars(text.data(), end, shard.index);
    const bool good = index_code == std::errc() && slash != end && *slash == '/';
    const auto [rest, count_code] =
        good ? std::from_chars(slash + 1, end, shard.count) : std::from_chars_result{end, {}};
    if (!good || count_code != std::errc() || rest != end || shard.index >= shard.count ||
        shard.count > ranges::shards.high)
        return Error{"--shard: \"" + text + "\" is not a part such as 0/4, counted from 0"};
    return shard;
}

/// Parses "scene", or two corners "x,y,z,x,y,z".
Result<std::optional<std::array<Vec3, 2>>> parse_box(const std::string& text) {
    if (text == "scene") return std::optional<std::array<Vec3, 2>>();
    const auto numbers = parse_numbers(text);
    if (!numbers || numbers->size() != 6)
        return Error{"--probes: \"" + text + "\" is neither \"scene\" nor two corners such as -1,0,-1,1,2,1"};
    const std::vector<float>& v = *numbers;
    if (v[0] > v[3] || v[1] > v[4] || v[2] > v[5]) return Error{"--probes: the first corner must be the lower one"};
    return std::optional(std::array{Vec3{v[0], v[1], v[2]}, Vec3{v[3], v[4], v[5]}});
}

Result<std::optional<ProbeOptions>> parse_probes(const BakeArguments& a) {
    if (a.probe_box.empty()) {
        if (a.probe_spacing) return Error{"--probe-spacing requires --probes"};
        return std::optional<ProbeOptions>();
    }
    const auto box = parse_box(a.probe_box);
    if (!box) return box.error();
    ProbeOptions probes = a.probes;
    probes.spacing = a.probe_spacing.value_or(probes.spacing);
    probes.box = *box;
    return std::optional(probes);
}

/// Nothing for the default; "none" is an empty list.
Result<std::optional<std::vector<std::string>>> parse_storages(const std::vector<std::string>& names) {
    if (names.empty()) return std::optional<std::vector<std::string>>();
    if (std::find(names.begin(), names.end(), "none") == names.end()) return std::optional(names);
    if (names.size() > 1) return Error{"--storage: \"none\" excludes all others"};
    return std::optional(std::vector<std::string>());
}

Result<LatLong> parse_size(const char* option, const std::string& text) {
    const auto size = parse_grid(text);
    if (!size) return Error{std::string(option) + ": " + size.error().message};
    constexpr auto most = static_cast<std::size_t>(ranges::side.high);
    if (size->width > most || size->height > most)
        return Error{std::string(option) + ": \"" + text + "\" is larger than 16384x16384"};
    return *size;
}

Switch off_if(bool flag) { return flag ? Switch::off : Switch::on; }

}  // namespace

Result<BakeJob> job_of(const BakeArguments& a) {
    // Parse texts.
    const auto size = parse_size("--size", a.size), picture = parse_size("--picture-size", a.picture_size);
    const auto memory = parse_bytes("--memory", a.memory);
    const auto shard = parse_shard(a.shard, a.shard_by == "tiles" ? Shard::By::tiles : Shard::By::samples);
    const auto probes = parse_probes(a);
    const auto storages = parse_storages(a.storages);
    if (!size) return size.error();
    if (!picture) return picture.error();
    if (!memory) return memory.error();
    if (!shard) return shard.error();
    if (!probes) return probes.error();
    if (!storages) return storages.error();

    // Put the job together.
    using Layout = AtlasOptions::Layout;
    BakeJob job = a.job;
    if (a.plain) job.bake.codec.clear();
    job.bake.frame = a.frame == "world" ? Frame::world : Frame::tangent;
    job.bake.directions = a.directions == "uniform" ? DirectionChoice::uniform : DirectionChoice::mixture;
    job.bake.atlas.width = size->width;
    job.bake.atlas.height = size->height;
    job.bake.atlas.layout = a.layout == "shared"   ? Layout::shared
                            : a.layout == "packed" ? Layout::packed
                                                   : Layout::automatic;
    job.bake.memory = *memory;
    job.bake.shard = *shard;
    job.bake.push_out = off_if(a.no_push_out);
    job.bake.paths.next_event = off_if(a.no_next_event);
    job.bake.paths.roulette = off_if(a.no_roulette);
    job.finish = {off_if(a.no_denoise), off_if(a.no_seams), off_if(a.no_dilate)};
    job.probes = *probes;
    job.precision = a.precision == "half" ? Precision::half : Precision::full;
    job.textures.storages = *storages;
    job.textures.arrays = off_if(a.no_arrays);
    job.textures.zstd = a.zstd ? Switch::on : Switch::off;
    if (!a.exports.empty()) job.exports = a.exports;
    job.report.write = off_if(a.no_report);
    job.report.width = picture->width;
    job.report.height = picture->height;
    return job;
}

}  // namespace lobelia::cli
