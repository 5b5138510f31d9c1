// Progress, summary and report of a bake.
#include "cli/bake_session.h"

#include <fmt/format.h>

#include "bake/session/job_file.h"
#include "bake/write/manifest.h"
#include "cli/common.h"
#include "cli/scene_input.h"
#include "io/counted.h"
#include "report/bake_report.h"

namespace lobelia::cli {
namespace {

std::function<void(const BakeProgress&)> progress_line() {
    auto bar = labelled_progress_bar();
    if (!bar) return {};
    return [bar](const BakeProgress& p) {
        std::string text = p.stage == BakeProgress::Stage::texels ? "baking: " : "probes: ";
        if (p.rays_per_second > 0) text = fmt::format("{:.1f} Mray/s, ", p.rays_per_second * 1e-6);
        text += fmt::format("pass {} of {}", p.pass, p.passes);
        if (p.seconds_left > 1) text += fmt::format(", {:.0f} s left", p.seconds_left);
        if (p.error > 0) text += fmt::format(", error {:.2g} %", 100 * p.error);
        bar(p.done, text);
    };
}

void print_summary(const Bake& bake) {
    const BakeStatistics& s = bake.manifest.statistics;
    const BakeOptions& options = bake.manifest.options;
    print_line("{} on {} of {}x{}, {} each{}", counted(s.texels, "texel"), counted(bake.pages.size(), "page"),
               bake.manifest.width, bake.manifest.height, counted(s.samples, "sample"),
               options.target_error ? " at most" : "");
    print_line("{:.1f} million rays in {:.2f} s, {:.1f} Mray/s", static_cast<double>(s.rays) * 1e-6, s.seconds,
               s.seconds > 0 ? static_cast<double>(s.rays) * 1e-6 / s.seconds : 0);
    const std::string error =
        s.samples > options.samples_per_pass ? fmt::format("{:.2f} %", 100 * s.mean_error) : "unknown after one pass";
    const std::string invalid =
        s.invalid_texels == 0
            ? "no invalid texels"
            : fmt::format("{}, {} under other surfaces", counted(s.invalid_texels, "invalid texel"), s.buried_texels);
    print_line("standard error of E {}, leaks {:.2f} %, {}", error, 100 * s.back_face_share, invalid);
    if (!options.codec.empty())
        print_line("codec irradiance error {:.2f} % RMS; {:.2f} % of evaluations negative; ringing {:.2f} %",
                   100 * s.codec_error, 100 * s.negative_share, 100 * s.ringing);
    if (bake.probes) print_line(counted(bake.probes->size(), "probe"));
}

Status stopped(BakeSession& session, const BakeOptions& options) {
    if (options.only_object)
        complain(fmt::format("lobelia: stopped; the bake in {} is unchanged", session.folder.string()));
    else if (!holds_job(session.folder))
        complain("lobelia: stopped, before anything was baked");
    else
        complain(fmt::format("lobelia: stopped; continue with: lobelia bake --resume -o {}", session.folder.string()));
    session.lock.reset();
    StopOnInterrupt::end_program();
    return Error{"stopped", Error::Kind::stopped};
}

Status write_report(const Scene& scene, const BakeJob& job, const Bake& bake, const BakeSession& session) {
    RenderOptions pictures;
    pictures.threads = job.bake.threads;
    pictures.stop = session.stop;
    pictures.progress = progress_bar();
    const auto html = bake_report(scene, bake, job.report, pictures);
    if (!html) return html.error();
    const FileContent file{session.folder / k_report_name, *html};
    return write_into_folder(session.folder, {&file, 1});
}

}  // namespace

Result<BakeSession> session_in(const std::string& out) {
    if (auto status = check_folder(out); !status) return status.error();
    auto lock = lock_folder(out);
    if (!lock) return lock.error();
    BakeSession session;
    session.folder = out;
    session.lock = *std::move(lock);
    session.progress = progress_line();
    session.warn = [](const std::string& text) { complain("lobelia: warning: " + text); };
    return session;
}

Result<LoadedScene> load_scene_in(BakeSession& session, const SceneSource& source, const StopOnInterrupt& stop) {
    session.stop = &stop.flag();
    auto loaded = load_scene_to_bake(source, stop.flag());
    if (loaded) {
        session.earlier_warnings = loaded->warnings;
        return loaded;
    }
    session.lock.reset();
    return ended(loaded.error(), stop);
}

Status finish_session(const Scene& scene, const BakeJob& job, const Result<Bake>& baked, BakeSession& session) {
    const std::string out = session.folder.string();
    const bool report = baked && job.report.write == Switch::on && job.bake.shard.count == 1;
    const Status status = !baked   ? Status(baked.error())
                          : report ? write_report(scene, job, *baked, session)
                                   : Status(Done{});
    if (!status) return status.error().kind == Error::Kind::stopped ? stopped(session, job.bake) : status;
    if (job.bake.shard.count > 1) {
        print_line("part {} of {} is done: {}", job.bake.shard.index, job.bake.shard.count, out);
        return Done{};
    }
    print_summary(*baked);
    print_line((session.folder / (report ? k_report_name : k_manifest_name)).string());
    return Done{};
}

}  // namespace lobelia::cli
