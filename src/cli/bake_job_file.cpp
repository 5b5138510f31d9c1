// Jobs as files: what resume, add-samples, rebake and merge go by.
#include <fmt/format.h>

#include "bake/write/bake_fields.h"
#include "bake/write/page_files.h"
#include "cli/bake_job.h"
#include "cli/common.h"
#include "io/write_file.h"

namespace lobelia {

void fields(auto& archive, Vec3& v) {
    std::array<double, 3> c{v.x, v.y, v.z};
    archive.number("x", c[0]);
    archive.number("y", c[1]);
    archive.number("z", c[2]);
    v = {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])};
}

void fields(auto& archive, ProbeOptions& options) {
    archive.number("spacing", options.spacing);
    bool has_box = options.box.has_value();
    archive.flag("in_box", has_box);
    if (has_box) {
        if (!options.box) options.box.emplace();
        archive.group("lowest", (*options.box)[0]);
        archive.group("highest", (*options.box)[1]);
    }
    archive.text("codec", options.codec);
    archive.whole("levels", options.levels, 0, 6);
    archive.number("tolerance", options.tolerance);
    archive.whole("samples", options.samples, 1, k_any_u32);
}

namespace cli {
namespace {

constexpr std::uint64_t k_version = 1;
constexpr std::uint64_t k_any_size = std::uint64_t{1} << 40;

std::filesystem::path job_file(const std::filesystem::path& out) { return checkpoint_folder(out) / "job.json"; }

/// Hands the options of a scene to an archive by their types.
template <class Archive>
struct SceneFields {
    Archive& archive;
    void operator()(const char* name, bool& value) { archive.flag(name, value); }
    void operator()(const char* name, std::size_t& value) { archive.whole(name, value, 0, k_any_size); }
    void operator()(const char* name, std::optional<double>& value) { archive.number(name, value); }
    template <class Text>
    void operator()(const char* name, Text& value) {
        archive.text(name, value);
    }
};

}  // namespace

void fields(auto& archive, SceneOptions& options) {
    SceneFields<std::remove_reference_t<decltype(archive)>> by_type{archive};
    visit_scene_fields(by_type, options);
}

void fields(auto& archive, FinishSteps& steps) {
    archive.choice("denoise", steps.denoise, k_switch_names);
    archive.choice("seams", steps.seams, k_switch_names);
    archive.choice("dilate", steps.dilate, k_switch_names);
}

/// Threads and time limits are each session's own; the regions of a checkpoint follow the memory.
void fields(auto& archive, BakeJob& job) {
    archive.group("scene", job.scene);
    archive.text("codec", job.bake.codec);
    archive.choice("frame", job.bake.frame, k_frame_names);
    archive.whole("width", job.bake.atlas.width, 1, 16384);
    archive.whole("height", job.bake.atlas.height, 1, 16384);
    archive.whole("memory", job.bake.memory, 0, k_any_u64);
    archive.group("bake", job.bake);
    archive.group("finish", job.finish);
    archive.group("probes", job.probes);
    archive.choice("precision", job.precision, k_precision_names);
    archive.texts("storages", job.storages);
    archive.flag("page", job.page);
    archive.whole("picture_samples", job.picture_samples, 1, k_any_u32);
    archive.whole("picture_width", job.picture_width, 1, 16384);
    archive.whole("picture_height", job.picture_height, 1, 16384);
}

Status save_job(const BakeJob& job) {
    JsonFieldWriter writer;
    writer.whole("lobelia_bake_job", k_version, 0, k_version);
    BakeJob copy = job;
    fields(writer, copy);
    const std::string text = writer.object.dump(1) + "\n";
    const FileContent file{job_file(job.out), text};
    return write_into_folder(checkpoint_folder(job.out), {&file, 1});
}

Result<BakeJob> load_job(const std::filesystem::path& out) {
    const std::string path = job_file(out).string();
    std::error_code code;
    if (!std::filesystem::exists(path, code))
        return Error{out.string() + ": holds no bake to go on with: " + path + " is not there"};
    const auto text = read_text(path, 1);
    if (!text) return text.error();
    return read_json(*text, path, [&](const JsonPlace& top) {
        if (top.at("lobelia_bake_job").whole(0, k_any_u64) != k_version)
            top.at("lobelia_bake_job").refuse(fmt::format("this program reads version {}", k_version));
        BakeJob job;
        JsonFieldReader reader(top);
        fields(reader, job);
        job.out = out;
        job.bake.checkpoint = checkpoint_folder(out);
        return job;
    });
}

}  // namespace cli
}  // namespace lobelia
