// Jobs as JSON: one table of fields serves both directions.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli/bake_job.h"
#include "cli/common.h"
#include "io/write_file.h"

namespace lobelia::cli {
namespace {

using Json = nlohmann::json;

constexpr int k_version = 1;

/// Fields to JSON.
struct Writer {
    Json json = Json::object();
    template <class T>
    void operator()(const char* name, const T& value) {
        if constexpr (std::is_enum_v<T>)
            json[name] = static_cast<int>(value);
        else
            json[name] = value;
    }
    template <class T>
    void operator()(const char* name, const std::optional<T>& value) {
        if (value) json[name] = *value;
    }
};

/// Fields from JSON; what is missing keeps its default.
struct Reader {
    const Json& json;
    template <class T>
    void operator()(const char* name, T& value) {
        if (!json.contains(name)) return;
        if constexpr (std::is_enum_v<T>)
            value = static_cast<T>(json[name].template get<int>());
        else
            json[name].get_to(value);
    }
    template <class T>
    void operator()(const char* name, std::optional<T>& value) {
        if (json.contains(name)) value = json[name].template get<T>();
    }
};

/// Every field that the states or the output depend on; memory, threads and time limits are each session's own, but the
/// regions of a checkpoint follow the memory.
template <class Visit, class Job>
void visit_fields(Visit& field, Job& job) {
    auto& [scene, bake, finish, probes, precision, page, out] = job;
    visit_scene_fields(field, scene);
    field("codec", bake.codec);
    field("frame", bake.frame);
    field("width", bake.atlas.width);
    field("height", bake.atlas.height);
    field("texels_per_metre", bake.atlas.texels_per_metre);
    field("padding", bake.atlas.padding);
    field("layout", bake.atlas.layout);
    field("bounces", bake.paths.bounces);
    field("seed", bake.paths.seed);
    field("next_event", bake.paths.next_event);
    field("environment_table", bake.paths.environment_table);
    field("roulette", bake.paths.roulette);
    field("sun_size", bake.paths.sun_size);
    field("directions", bake.directions);
    field("push_out", bake.push_out);
    field("samples", bake.samples);
    field("samples_per_pass", bake.samples_per_pass);
    field("target_error", bake.target_error);
    field("memory", bake.memory);
    field("shard_by", bake.shard.by);
    field("shard_index", bake.shard.index);
    field("shard_count", bake.shard.count);
    field("denoise", finish.denoise);
    field("seams", finish.seams);
    field("dilate", finish.dilate);
    visit_probe_fields(field, probes);
    field("precision", precision);
    field("page", page);
}

std::filesystem::path job_file(const std::filesystem::path& out) { return checkpoint_folder(out) / "job.json"; }

}  // namespace

Status save_job(const BakeJob& job) {
    Writer writer;
    writer("lobelia_bake_job", k_version);
    visit_fields(writer, job);
    const std::string text = writer.json.dump(1) + "\n";
    const FileContent file{job_file(job.out), text};
    return write_into_folder(checkpoint_folder(job.out), {&file, 1});
}

Result<BakeJob> load_job(const std::filesystem::path& out) {
    const std::string path = job_file(out).string();
    std::error_code code;
    if (!std::filesystem::exists(path, code))
        return Error{out.string() + ": holds no bake that could be continued (no " + path + ")"};
    const auto text = read_text(path, 1);
    if (!text) return text.error();
    try {
        const Json json = Json::parse(*text);
        if (json.value("lobelia_bake_job", 0) != k_version)
            return Error{fmt::format("{}: is not a bake of this version ({})", path, k_version)};
        BakeJob job;
        Reader reader{json};
        visit_fields(reader, job);
        job.out = out;
        job.bake.checkpoint = checkpoint_folder(out);
        return job;
    } catch (const Json::exception& error) {
        return Error{path + ": " + error.what()};
    }
}

}  // namespace lobelia::cli
