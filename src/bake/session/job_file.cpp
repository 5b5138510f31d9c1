// Jobs as files beside their checkpoints.
#include "bake/session/job_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "bake/check_job.h"
#include "bake/session/checkpoint.h"
#include "bake/write/bake_fields.h"
#include "bake/write/page_files.h"
#include "io/commit_journal.h"
#include "io/folders.h"
#include "io/printable.h"
#include "io/read_file.h"

namespace lobelia {
namespace {

constexpr std::uint64_t k_job_version = 2;
constexpr std::uint64_t k_any_size = std::uint64_t{1} << 40;

/// A switch as true or false.
void flag(auto& archive, const char* name, Switch& value) {
    bool on = value == Switch::on;
    archive.flag(name, on);
    value = on ? Switch::on : Switch::off;
}

}  // namespace

void fields(auto& archive, Vec3& v) {
    std::array<double, 3> c{v.x, v.y, v.z};
    archive.number("x", c[0]);
    archive.number("y", c[1]);
    archive.number("z", c[2]);
    // Numbers beyond float32 become its largest: their conversion is undefined.
    static constexpr double k_largest = std::numeric_limits<float>::max();
    const auto in_range = [](double x) { return static_cast<float>(std::clamp(x, -k_largest, k_largest)); };
    v = {in_range(c[0]), in_range(c[1]), in_range(c[2])};
}

void fields(auto& archive, std::array<Vec3, 2>& box) {
    archive.group("lowest", box[0]);
    archive.group("highest", box[1]);
}

void fields(auto& archive, ProbeOptions& options) {
    archive.number("spacing", options.spacing);
    archive.group("box", options.box);
    archive.text("codec", options.codec);
    archive.whole("levels", options.levels, 0, 1u << 30);
    archive.number("tolerance", options.tolerance);
    archive.whole("samples", options.samples, 0, k_any_u32);
    archive.whole("visibility", options.visibility, 0, k_any_u32);
}

void fields(auto& archive, SceneSource& scene) {
    archive.text("scene", scene.path);
    archive.text("environment", scene.environment);
    flag(archive, "ldr", scene.ldr);
    flag(archive, "sanitize", scene.sanitize);
    archive.whole("uv_set", scene.uv_set, 0, k_any_size);
    flag(archive, "photometric", scene.photometric);
    archive.number("sun_elevation", scene.sun_elevation);
    archive.number("sun_azimuth", scene.sun_azimuth);
    archive.number("turbidity", scene.turbidity);
    archive.whole("scene_memory", scene.scene_memory, 0, k_any_u64);
}

void fields(auto& archive, FinishOptions& steps) {
    archive.choice("denoise", steps.denoise, k_switch_names);
    archive.choice("seams", steps.seams, k_switch_names);
    archive.choice("dilate", steps.dilate, k_switch_names);
}

void fields(auto& archive, ReportOptions& report) {
    flag(archive, "write", report.write);
    archive.whole("samples", report.samples, 0, k_any_u32);
    archive.whole("width", report.width, 0, k_any_size);
    archive.whole("height", report.height, 0, k_any_size);
}

/// Threads and time limits belong to each session; the regions of a checkpoint depend on the memory. Ranges: check().
void fields(auto& archive, BakeJob& job) {
    archive.group("scene", job.scene);
    archive.text("codec", job.bake.codec);
    archive.choice("frame", job.bake.frame, k_frame_names);
    archive.whole("width", job.bake.atlas.width, 0, k_any_size);
    archive.whole("height", job.bake.atlas.height, 0, k_any_size);
    archive.whole("memory", job.bake.memory, 0, k_any_u64);
    archive.group("bake", job.bake);
    archive.group("finish", job.finish);
    archive.group("probes", job.probes);
    archive.choice("precision", job.precision, k_precision_names);
    archive.texts("storages", job.textures.storages);
    archive.text("container", job.textures.container);
    archive.choice("texture_arrays", job.textures.arrays, k_switch_names);
    archive.whole("mip_levels", job.textures.levels, 0, k_any_u32);
    archive.choice("zstd", job.textures.zstd, k_switch_names);
    archive.texts("exports", job.exports);
    archive.group("report", job.report);
}

void fields(auto& archive, KeptJob& kept) {
    std::uint64_t version = k_job_version;
    archive.whole("lobelia_bake_job", version, 0, k_any_u64);
    fields(archive, kept.job);
    archive.texts("rebaked", kept.rebaked);
}

std::string to_json_text(const KeptJob& kept) {
    JsonFieldWriter writer;
    KeptJob copy = kept;
    fields(writer, copy);
    return json_text(writer.object, 1) + "\n";
}

Status save_job(const std::filesystem::path& folder, const BakeJob& job) {
    // JSON holds UTF-8 only, and a path must come back byte by byte.
    for (const std::string& path : {job.scene.path, job.scene.environment.value_or("")})
        if (!is_utf8(path))
            return Error{path + ": a bake cannot be continued with a path that is not UTF-8; rename the file"};
    const std::string text = to_json_text(KeptJob{job, {}});
    const FileContent file{folder / k_job_name, text};
    return write_into_folder(checkpoint_folder(folder), {&file, 1});
}

bool holds_job(const std::filesystem::path& folder) {
    std::error_code code;
    const auto committed = CommittedFolder::open(folder);
    return committed && std::filesystem::exists(committed->path(k_job_name), code);
}

Result<KeptJob> read_kept_job(const std::filesystem::path& folder) {
    const auto committed = CommittedFolder::open(folder);
    if (!committed) return committed.error();
    const std::string path = committed->path(k_job_name).string();
    std::error_code code;
    if (!std::filesystem::exists(path, code))
        return Error{folder.string() + ": holds no bake to continue: " + path + " does not exist"};
    constexpr std::uint64_t k_most_bytes = std::uint64_t{1} << 20;
    const auto file = open_in_checkpoint(path, k_most_bytes);
    if (!file) return file.error();
    const auto text = read_text(*file);
    if (!text) return text.error();
    return read_json(*text, path, [&](const JsonPlace& top) {
        if (top.at("lobelia_bake_job").whole(0, k_any_u64) != k_job_version)
            top.at("lobelia_bake_job").refuse(fmt::format("this program reads version {}", k_job_version));
        KeptJob kept;
        JsonFieldReader reader(top, JsonFieldReader::Unknown::refused);
        fields(reader, kept);
        reader.finish();
        if (const auto valid = check(kept.job); !valid) top.refuse(valid.error().message);
        for (const std::string& codec : {kept.job.bake.codec, kept.job.probes.value_or(ProbeOptions()).codec})
            if (const auto name = parse_codec_name(codec); !codec.empty() && !name) top.refuse(name.error().message);
        return kept;
    });
}

Result<BakeJob> read_job(const std::filesystem::path& folder) {
    auto kept = read_kept_job(folder);
    return kept ? Result<BakeJob>(std::move(kept->job)) : kept.error();
}

Status check_same_options(const Manifest& manifest, const BakeJob& job) {
    const auto text = [](BakeOptions options) {
        options.most_seconds.reset();
        options.only_object.reset();
        options.shard = {};
        JsonFieldWriter writer;
        fields(writer, options);
        return writer.object.dump() + options.codec;
    };
    const auto& [width, height] = std::pair(job.bake.atlas.width, job.bake.atlas.height);
    if (text(manifest.options) == text(job.bake) && manifest.width == width && manifest.height == height) return Done{};
    return Error{
        fmt::format("the finished bake ({}, {} samples) has other options than the job of its checkpoint ({}, {} "
                    "samples), which is unfinished; complete it first with --resume",
                    manifest.options.codec, manifest.options.samples, job.bake.codec, job.bake.samples)};
}

}  // namespace lobelia
