// Scenes and bakes: options by value, the result as float arrays.
#include "lobelia/bake.h"

#include <algorithm>
#include <atomic>
#include <cstring>

#include "c/handles.h"

using namespace lobelia;
using namespace lobelia::c;

struct lob_scene {
    LoadedScene loaded;
};

struct lob_stop {
    std::atomic<bool> flag = false;
};
// Signal handlers may set it.
static_assert(std::atomic<bool>::is_always_lock_free);

struct lob_bake {
    Bake bake;
    std::vector<std::string> channels = bake.channels().names();
};

namespace {

Switch to_switch(int on) { return on != 0 ? Switch::on : Switch::off; }

lob_bake_options default_options() {
    const BakeJob job;
    // Keep the default codec's name as long as the program runs.
    static const std::string codec = job.bake.codec;
    lob_bake_options o = {};
    o.struct_size = sizeof o;
    o.codec = codec.c_str();
    o.width = job.bake.atlas.width;
    o.height = job.bake.atlas.height;
    o.samples = job.bake.samples;
    o.bounces = static_cast<std::uint32_t>(job.bake.paths.bounces);
    o.seed = job.bake.paths.seed;
    o.memory = job.bake.memory;
    o.denoise = o.seams = o.dilate = o.push_out = 1;
    return o;
}

/// The caller's options; fields that a program compiled with an older header does not have keep their defaults.
lob_bake_options complete(const lob_bake_options* given) {
    lob_bake_options options = default_options();
    if (given != nullptr) std::memcpy(&options, given, std::min(given->struct_size, sizeof options));
    return options;
}

BakeJob to_job(const lob_bake_options& o) {
    BakeJob job;
    if (o.codec != nullptr) job.bake.codec = o.codec;
    job.bake.atlas.width = o.width;
    job.bake.atlas.height = o.height;
    if (o.texels_per_metre != 0) job.bake.atlas.texels_per_metre = o.texels_per_metre;
    job.bake.samples = o.samples;
    job.bake.paths.bounces = static_cast<int>(std::min<std::uint32_t>(o.bounces, 1000));
    job.bake.paths.seed = o.seed;
    job.bake.threads = o.threads;
    job.bake.memory = o.memory;
    if (o.most_seconds != 0) job.bake.most_seconds = o.most_seconds;
    if (o.target_error != 0) job.bake.target_error = o.target_error;
    if (o.probe_spacing != 0) job.probes.emplace().spacing = o.probe_spacing;
    job.bake.frame = o.tangent_frame != 0 ? Frame::tangent : Frame::world;
    job.finish = {to_switch(o.denoise), to_switch(o.seams), to_switch(o.dilate)};
    job.bake.push_out = to_switch(o.push_out);
    job.report.write = Switch::off;
    return job;
}

BakeSession to_session(const lob_bake_options& o) {
    BakeSession session;
    if (o.folder != nullptr) session.folder = o.folder;
    session.start = o.resume != 0 ? BakeSession::Start::resume : BakeSession::Start::fresh;
    if (o.stop != nullptr) session.stop = &o.stop->flag;
    if (o.progress != nullptr)
        session.progress = [&o](const BakeProgress& p) {
            o.progress(o.user, p.done, p.stage == BakeProgress::Stage::texels ? "texels" : "probes");
        };
    if (o.warning != nullptr) session.warn = [&o](const std::string& text) { o.warning(o.user, text.c_str()); };
    return session;
}

}  // namespace

lob_status lob_scene_load(const char* path, lob_scene** out) {
    return guarded([&] {
        if (auto status = check_pointers("lob_scene_load", path, out)) return status;
        SceneSource source;
        source.path = path;
        auto loaded = load_scene(source);
        if (!loaded) return fail(LOB_BAD_INPUT, loaded.error().message);
        *out = new lob_scene{*std::move(loaded)};
        return LOB_OK;
    });
}

lob_status lob_scene_set_environment(lob_scene* scene, const lob_environment* environment) {
    return guarded([&] {
        if (auto status = check_pointers("lob_scene_set_environment", scene)) return status;
        std::optional<Image> image;
        if (environment != nullptr) image = environment->image;
        scene->loaded.scene.environment = std::move(image);
        // An image in memory has no name for the command line.
        scene->loaded.source = {};
        return LOB_OK;
    });
}

void lob_scene_free(lob_scene* scene) { delete scene; }

lob_status lob_stop_create(lob_stop** out) {
    return guarded([&] {
        if (auto status = check_pointers("lob_stop_create", out)) return status;
        *out = new lob_stop;
        return LOB_OK;
    });
}

void lob_stop_set(lob_stop* stop) {
    if (stop != nullptr) stop->flag = true;
}

void lob_stop_free(lob_stop* stop) { delete stop; }

void lob_bake_options_init(lob_bake_options* options, size_t struct_size) {
    if (options == nullptr) return;
    (void)guarded([&] {
        lob_bake_options defaults = default_options();
        defaults.struct_size = std::min(struct_size, sizeof defaults);
        std::memcpy(options, &defaults, defaults.struct_size);
        return LOB_OK;
    });
}

lob_status lob_bake_scene(const lob_scene* scene, const lob_bake_options* options, lob_bake** out) {
    return guarded([&] {
        if (auto status = check_pointers("lob_bake_scene", scene, out)) return status;
        const lob_bake_options all = complete(options);
        BakeJob job = to_job(all);
        job.scene = scene->loaded.source;
        BakeSession session = to_session(all);
        session.earlier_warnings = scene->loaded.warnings;
        auto baked = bake(scene->loaded.scene, job, session);
        if (!baked)
            return fail(baked.error().kind == Error::Kind::stopped ? LOB_STOPPED : LOB_BAD_INPUT,
                        baked.error().message);
        *out = new lob_bake{*std::move(baked)};
        return LOB_OK;
    });
}

lob_status lob_bake_read(const char* folder, lob_bake** out) {
    return guarded([&] {
        if (auto status = check_pointers("lob_bake_read", folder, out)) return status;
        auto baked = read_bake(folder);
        if (!baked) return fail(LOB_BAD_INPUT, baked.error().message);
        *out = new lob_bake{*std::move(baked)};
        return LOB_OK;
    });
}

lob_status lob_bake_write(const lob_bake* bake, const char* folder, const lob_scene* scene) {
    return guarded([&] {
        if (auto status = check_pointers("lob_bake_write", bake, folder)) return status;
        WriteBakeOptions options;
        if (scene != nullptr) options.scene = &scene->loaded.scene;
        const auto written = write_bake(folder, bake->bake, options);
        return written ? LOB_OK : fail(LOB_BAD_INPUT, written.error().message);
    });
}

void lob_bake_free(lob_bake* bake) { delete bake; }

const char* lob_bake_codec(const lob_bake* bake) {
    return bake == nullptr ? "" : bake->bake.manifest.options.codec.c_str();
}

size_t lob_bake_page_count(const lob_bake* bake) { return bake == nullptr ? 0 : bake->bake.pages.size(); }

size_t lob_bake_width(const lob_bake* bake) { return bake == nullptr ? 0 : bake->bake.manifest.width; }

size_t lob_bake_height(const lob_bake* bake) { return bake == nullptr ? 0 : bake->bake.manifest.height; }

size_t lob_bake_coefficient_count(const lob_bake* bake) {
    return bake == nullptr ? 0 : bake->bake.manifest.coefficients;
}

lob_status lob_bake_channel(const lob_bake* bake, size_t page, const char* channel, const float** out) {
    return guarded([&] {
        if (auto status = check_pointers("lob_bake_channel", bake, channel, out)) return status;
        if (page >= bake->bake.pages.size())
            return fail(LOB_MISUSE, "lob_bake_channel: page beyond lob_bake_page_count()");
        const LightmapPage& from = bake->bake.pages[page];
        if (std::strcmp(channel, "validity") == 0) {
            *out = from.validity.data();
            return LOB_OK;
        }
        const auto found = std::ranges::find(bake->channels, channel);
        if (found == bake->channels.end())
            return fail(LOB_BAD_INPUT, std::string("lob_bake_channel: no channel \"") + channel + "\"");
        *out = from.planes[static_cast<std::size_t>(found - bake->channels.begin())].data();
        return LOB_OK;
    });
}
