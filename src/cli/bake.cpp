// lobelia bake: a scene in, lightmaps and probes out.
#include <fmt/format.h>

#include "bake/preflight/preflight.h"
#include "cli/bake_options.h"
#include "cli/bake_session.h"
#include "cli/common.h"
#include "cli/options.h"
#include "cli/scene_input.h"
#include "cli/verbs.h"

namespace lobelia::cli {
namespace {

/// Prints the preflight, and writes a picture of each page.
Status print_preflight(const Preflight& checked, const Scene& scene, const std::string& out) {
    print_text(to_text(checked, scene));
    std::vector<std::string> pictures;
    std::vector<FileContent> files;
    for (std::size_t page = 0; page < checked.pages.size(); ++page) {
        auto png = encode_png(preflight_picture(checked, page));
        if (!png) return png.error();
        pictures.push_back(std::move(*png));
    }
    for (std::size_t page = 0; page < pictures.size(); ++page)
        files.push_back({std::filesystem::path(out) / fmt::format("preflight-{}.png", page), pictures[page]});
    if (auto status = write_into_folder(out, files); !status) return status;
    for (const FileContent& file : files) print_line(file.path.string());
    return Done{};
}

Status preflight_alone(const BakeJob& job, const std::string& out) {
    const StopOnInterrupt stop;
    const auto loaded = load_scene_to_bake(job.scene, stop.flag());
    if (!loaded) return ended(loaded.error(), stop);
    for (const auto& warning : loaded->warnings) complain("lobelia: warning: " + warning);
    const auto checked = preflight(loaded->scene, job, &stop.flag());
    return checked ? print_preflight(*checked, loaded->scene, out) : ended(checked.error(), stop);
}

Status bake_fresh(const BakeArguments& arguments) {
    if (arguments.job.scene.path.empty())
        return Error{"bake: a scene is missing: a .glb or .gltf file, or cornell or colonnade"};
    const auto job = job_of(arguments);
    if (!job) return job.error();
    if (auto status = check_folder(arguments.out); !status) return status;
    if (arguments.preflight) return preflight_alone(*job, arguments.out);
    const StopOnInterrupt stop;
    auto session = session_in(arguments.out);
    if (!session) return session.error();
    const auto loaded = load_scene_in(*session, job->scene, stop);
    if (!loaded) return loaded.error();
    return finish_session(loaded->scene, *job, bake(loaded->scene, *job, *session), *session);
}

/// Continues a bake, or bakes an object again. Only threads and the time limit are this session's own.
Status bake_again(const BakeArguments& arguments) {
    auto session = session_in(arguments.out);
    if (!session) return session.error();
    auto job = read_job(arguments.out);
    if (!job) return job.error();
    const std::string& path = arguments.job.scene.path;
    if (!path.empty() && path != job->scene.path)
        return Error{"bake: " + arguments.out + " holds a bake of " + job->scene.path + ", not of " + path +
                     "; the scene need not be repeated"};
    job->bake.threads = arguments.job.bake.threads;
    job->bake.most_seconds = arguments.job.bake.most_seconds;
    job->bake.samples += arguments.add_samples;
    const StopOnInterrupt stop;
    const auto loaded = load_scene_in(*session, job->scene, stop);
    if (!loaded) return loaded.error();
    const Scene& scene = loaded->scene;
    if (arguments.rebake_object.empty()) {
        session->start = BakeSession::Start::resume;
        return finish_session(scene, *job, bake(scene, *job, *session), *session);
    }
    auto there = read_bake(arguments.out);
    if (!there) return there.error();
    const auto baked = rebake_object(scene, *job, arguments.rebake_object, *std::move(there), *session);
    job->bake.only_object = arguments.rebake_object;
    return finish_session(scene, *job, baked, *session);
}

}  // namespace

Verb add_bake(CLI::App& app) {
    auto arguments = std::make_shared<BakeArguments>();
    CLI::App* command = app.add_subcommand("bake", "Bake a scene's light into lightmaps and probes");
    add_bake_options(*command, *arguments);
    return {command, [arguments]() {
                const bool again = arguments->resume || arguments->add_samples > 0 || !arguments->rebake_object.empty();
                return again ? bake_again(*arguments) : bake_fresh(*arguments);
            }};
}

}  // namespace lobelia::cli
