// Jobs as files beside their checkpoints.
#include "bake/write/job_file.h"

#include <fmt/format.h>

#include "bake/session/checkpoint.h"
#include "bake/write/bake_fields.h"
#include "bake/write/page_files.h"
#include "bake/write/stored_codec.h"
#include "io/folders.h"
#include "io/printable.h"
#include "io/read_file.h"

namespace lobelia {
namespace {

constexpr std::uint64_t k_version = 2;
constexpr std::uint64_t k_any_size = std::uint64_t{1} << 40;
constexpr std::uint64_t k_most_side = 16384;

std::filesystem::path job_file(const std::filesystem::path& checkpoint) { return checkpoint / "job.json"; }

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
    v = {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])};
}

void fields(auto& archive, std::array<Vec3, 2>& box) {
    archive.group("lowest", box[0]);
    archive.group("highest", box[1]);
}

void fields(auto& archive, ProbeOptions& options) {
    archive.number("spacing", options.spacing);
    archive.group("box", options.box);
    archive.text("codec", options.codec);
    archive.whole("levels", options.levels, 0, 6);
    archive.number("tolerance", options.tolerance);
    archive.whole("samples", options.samples, 1, k_any_u32);
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
}

void fields(auto& archive, FinishOptions& steps) {
    archive.choice("denoise", steps.denoise, k_switch_names);
    archive.choice("seams", steps.seams, k_switch_names);
    archive.choice("dilate", steps.dilate, k_switch_names);
}

void fields(auto& archive, ReportOptions& report) {
    flag(archive, "write", report.write);
    archive.whole("samples", report.samples, 1, k_any_u32);
    archive.whole("width", report.width, 1, k_most_side);
    archive.whole("height", report.height, 1, k_most_side);
}

/// Threads and time limits belong to each session; the regions of a checkpoint depend on the memory.
void fields(auto& archive, BakeJob& job) {
    archive.group("scene", job.scene);
    archive.text("codec", job.bake.codec);
    archive.choice("frame", job.bake.frame, k_frame_names);
    archive.whole("width", job.bake.atlas.width, 1, k_most_side);
    archive.whole("height", job.bake.atlas.height, 1, k_most_side);
    archive.whole("memory", job.bake.memory, 0, k_any_u64);
    archive.group("bake", job.bake);
    archive.group("finish", job.finish);
    archive.group("probes", job.probes);
    archive.choice("precision", job.precision, k_precision_names);
    archive.texts("storages", job.storages);
    archive.group("report", job.report);
}

Status save_job(const std::filesystem::path& checkpoint, const BakeJob& job) {
    // JSON holds UTF-8 only, and a path must come back byte by byte.
    for (const std::string& path : {job.scene.path, job.scene.environment.value_or("")})
        if (!is_utf8(path))
            return Error{path + ": a bake cannot be continued with a path that is not UTF-8; rename the file"};
    JsonFieldWriter writer;
    writer.whole("lobelia_bake_job", k_version, 0, k_version);
    BakeJob copy = job;
    fields(writer, copy);
    const std::string text = json_text(writer.object, 1) + "\n";
    const FileContent file{job_file(checkpoint), text};
    return write_into_folder(checkpoint, {&file, 1});
}

Result<BakeJob> read_job(const std::filesystem::path& folder) {
    const std::string path = job_file(checkpoint_folder(folder)).string();
    std::error_code code;
    if (!std::filesystem::exists(path, code))
        return Error{folder.string() + ": holds no bake to continue: " + path + " does not exist"};
    const auto text = read_text(path, 1);
    if (!text) return text.error();
    return read_json(*text, path, [&](const JsonPlace& top) {
        if (top.at("lobelia_bake_job").whole(0, k_any_u64) != k_version)
            top.at("lobelia_bake_job").refuse(fmt::format("this program reads version {}", k_version));
        BakeJob job;
        JsonFieldReader reader(top);
        fields(reader, job);
        for (const std::string& codec : {job.bake.codec, job.probes.value_or(ProbeOptions()).codec})
            if (const auto name = stored_codec_name(codec); !codec.empty() && !name) top.refuse(name.error().message);
        return job;
    });
}

}  // namespace lobelia
