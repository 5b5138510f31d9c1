// The course of a job, from the scene's file to the finished folder.
#include "cli/bake_job.h"

#include <fmt/format.h>

#include "bake/session/checkpoint.h"
#include "bake/session/merge.h"
#include "bake/write/bake_folder.h"
#include "bake/write/page_textures.h"
#include "cli/common.h"
#include "cli/interrupt.h"
#include "io/counted.h"
#include "io/staged_file.h"
#include "lobelia/sample.h"

namespace lobelia::cli {
namespace {

namespace fs = std::filesystem;

BakeProgressSink progress_line(const char* what) {
    auto bar = labelled_progress_bar();
    if (!bar) return {};
    return [bar, what](const BakeProgress& p) {
        std::string text = what;
        text += ": ";
        if (p.rays_per_second > 0) text = fmt::format("{:.1f} Mray/s, ", p.rays_per_second * 1e-6);
        text += fmt::format("pass {} of {}", p.pass, p.passes);
        if (p.seconds_left > 1) text += fmt::format(", {:.0f} s left", p.seconds_left);
        if (p.error > 0) text += fmt::format(", error {:.2g} %", 100 * p.error);
        bar(p.done, text);
    };
}

/// Puts what was baked anew, an object's texels, among those of the finished bake that is there; `fresh` becomes all.
Status put_among(Bake& bake, const Baker& baker, std::vector<Page>& fresh) {
    const PageLayout layout = bake.layout();
    if (bake.pages.size() != fresh.size() || layout.channels() != fresh.front().planes.size() ||
        bake.pages.front().size() != fresh.front().size())
        return Error{"--rebake-object: the bake that is there has other pages"};
    for (const CoveredTexel& at : baker.texels().texels) {
        Page &to = bake.pages[at.page], &from = fresh[at.page];
        const std::size_t pixel = at.y * to.width + at.x;
        for (std::size_t k = 0; k < layout.channels(); ++k) to.planes[k][pixel] = from.planes[k][pixel];
        to.chart[pixel] = from.chart[pixel];
        to.validity[pixel] = from.validity[pixel];
    }
    fresh = std::move(bake.pages);
    return Done{};
}

void denoise_if(Switch wanted, std::vector<Page>& pages, const Baker& baker, const Guides& guides) {
    if (wanted == Switch::off) return;
    const Basis* basis = baker.page_basis();
    if (basis == nullptr) return denoise(pages, baker.layout(), guides, {}, solid_angle(Domain::hemisphere));
    if (basis->linear() == nullptr)
        return complain("lobelia: warning: not denoised: the coefficients of " + basis->name() +
                        " are not linear in the light");
    denoise(pages, baker.layout(), guides, basis->linear()->integrals(), solid_angle(basis->domain()));
}

/// The last step, where the pages do not hold the codec's own coefficients yet.
void fit_if_needed(std::vector<Page>& pages, const Baker& baker) {
    if (baker.page_basis() == nullptr || baker.page_basis() == &baker.codec()->basis()) return;
    pages = fit_pages(pages, *baker.codec()->basis().fitted());
}

void print_summary(const Baker& baker, const Bake& bake) {
    const BakeStatistics& s = baker.statistics();
    const bool even = !baker.options().target_error;
    fmt::print("{} on {} of {}x{}, {} each{}\n", counted(s.texels, "texel"), counted(bake.pages.size(), "page"),
               baker.atlas().width(), baker.atlas().height(), counted(s.samples, "sample"), even ? "" : " at most");
    fmt::print("{:.1f} million rays in {:.2f} s, {:.1f} Mray/s\n", static_cast<double>(s.rays) * 1e-6, s.seconds,
               s.seconds > 0 ? static_cast<double>(s.rays) * 1e-6 / s.seconds : 0);
    const std::string error = s.samples > baker.options().samples_per_pass ? fmt::format("{:.2f} %", 100 * s.mean_error)
                                                                           : "not known from one pass";
    const std::string invalid = s.invalid_texels == 0
                                    ? "no invalid texels"
                                    : fmt::format("{}, {} of them under other surfaces",
                                                  counted(s.invalid_texels, "invalid texel"), s.buried_texels);
    fmt::print("standard error of E {}, leaks {:.2f} %, {}\n", error, 100 * s.back_face_share, invalid);
    if (baker.codec() != nullptr)
        fmt::print("E by the codec off by {:.2f} %, negative {:.2f} %, ringing {:.2f} %\n", 100 * s.codec_error,
                   100 * s.negative_share, 100 * s.ringing);
    if (bake.probes) fmt::print("{}\n", counted(bake.probes->size(), "probe"));
}

/// What Ctrl-C leaves: the line that says how to go on, and the exit that shells expect.
Status stopped(const fs::path& out, JobStart start) {
    complain(start == JobStart::rebake
                 ? fmt::format("lobelia: stopped; the bake in {} is as it was", out.string())
                 : fmt::format("lobelia: stopped; go on with: lobelia bake --resume -o {}", out.string()));
    StopOnInterrupt::end_program();
    return Error{"stopped"};
}

/// One job on its way.
class JobRun {
  public:
    JobRun(const BakeJob& job, JobStart start, const std::atomic<bool>& stop) : job_(job), start_(start), stop_(stop) {}

    [[nodiscard]] Status prepare();
    [[nodiscard]] Status bake(std::span<const fs::path> shards);
    [[nodiscard]] Status finish();
    [[nodiscard]] Status write();

  private:
    void warn(const std::string& text);
    [[nodiscard]] Status finish_pages(const Guides& guides);

    const BakeJob& job_;
    JobStart start_;
    const std::atomic<bool>& stop_;
    std::optional<LoadedScene> loaded_;
    std::unique_ptr<Baker> baker_;
    std::vector<std::string> warnings_;
    Preflight checked_;
    Bake bake_;
};

/// Says it now, in the manifest and on the page.
void JobRun::warn(const std::string& text) {
    complain("lobelia: warning: " + text);
    warnings_.push_back(text);
}

/// Everything that is cheap to refuse, and warnings.
Status JobRun::prepare() {
    if (auto status = check_folder(job_.out); !status) return status;
    std::error_code code;
    const fs::path states = region_file(checkpoint_folder(job_.out), 0);
    if (start_ == JobStart::fresh && fs::exists(states, code))
        return Error{states.string() +
                     ": is the checkpoint of an earlier bake; continue it with --resume, or remove it"};
    if (const auto textures = PageTextures::make(job_.bake.codec, job_.storages); !textures) return textures.error();
    auto loaded = load_scene_to_bake(job_.scene);
    if (!loaded) return loaded.error();
    loaded_ = std::move(*loaded);
    for (const auto& warning : loaded_->warnings) warn(warning);
    auto baker = Baker::make(loaded_->scene, job_.bake);
    if (!baker) return baker.error();
    baker_ = std::move(*baker);
    if (!baker_->tracer().has_light()) warn("the scene has no light; everything will be black");
    if (job_.probes.spacing > 0)
        if (auto status = check(job_.probes, baker_->tracer().world()); !status) return status;
    checked_ = preflight_of(*baker_);
    for (const auto& warning : warnings(checked_, loaded_->scene)) warn(warning);
    return Done{};
}

Status JobRun::bake(std::span<const fs::path> shards) {
    if (start_ == JobStart::merged)
        if (auto status = merge_shards(*baker_, shards); !status) return status;
    if (start_ != JobStart::rebake)
        if (auto status = save_job(job_); !status) return status;
    const bool from_nothing = start_ == JobStart::fresh || start_ == JobStart::rebake;
    return baker_->run(from_nothing ? Baker::Start::fresh : Baker::Start::resume, stop_, progress_line("baking"));
}

/// Denoised, put among what is there, seams closed, dilated.
Status JobRun::finish_pages(const Guides& guides) {
    std::vector<Page>& pages = baker_->pages();
    denoise_if(job_.finish.denoise, pages, *baker_, guides);
    if (start_ == JobStart::rebake) {
        fit_if_needed(pages, *baker_);
        auto there = read_bake(job_.out);
        if (!there) return there.error();
        if (auto status = put_among(*there, *baker_, pages); !status) return status;
        bake_.probes = std::move(there->probes);
        bake_.manifest.statistics = there->manifest.statistics;
        bake_.manifest.options.only_object.reset();
    }
    const bool fitted = pages.front().planes.size() != baker_->layout().channels();
    if (job_.finish.seams == Switch::on && !fitted) close_seams(pages, baker_->layout(), baker_->atlas());
    if (job_.finish.dilate == Switch::on) dilate(pages);
    if (!fitted) fit_if_needed(pages, *baker_);
    bake_.pages = std::move(pages);
    return Done{};
}

Status JobRun::finish() {
    BakeOptions options = job_.bake;
    options.frame = baker_->in_tangent_frame() ? Frame::tangent : Frame::world;
    bake_.manifest = make_manifest(loaded_->scene, baker_->atlas(), options, baker_->statistics());
    bake_.manifest.precision = job_.precision;
    bake_.manifest.warnings = warnings_;
    if (job_.finish.denoise == Switch::on) bake_.manifest.finish.emplace_back("denoise");
    if (job_.finish.seams == Switch::on) bake_.manifest.finish.emplace_back("seams");
    if (job_.finish.dilate == Switch::on) bake_.manifest.finish.emplace_back("dilate");
    Guides guides = make_guides(baker_->atlas(), map_texels(baker_->atlas()));
    if (auto status = finish_pages(guides); !status) return status;
    bake_.normals = std::move(guides.normal);
    if (!(job_.probes.spacing > 0) || start_ == JobStart::rebake) return Done{};
    auto probes = bake_probes(baker_->tracer(), job_.probes, job_.bake.threads, stop_, progress_line("probes"));
    if (!probes) return probes.error();
    bake_.probes = std::move(*probes);
    return Done{};
}

Status JobRun::write() {
    std::string page;
    if (job_.page) {
        auto made = job_page(job_, loaded_->scene, *baker_, bake_, checked_, stop_);
        if (!made) return made.error();
        page = std::move(*made);
    }
    if (auto status = write_bake(job_.out, bake_, {job_.storages, &loaded_->scene}); !status) return status;
    const fs::path shown = job_.out / (job_.page ? "bake.html" : "bake.json");
    if (job_.page)
        if (auto status = write_file_atomically(shown, page); !status) return status;
    // The states do not know what was baked anew.
    std::error_code code;
    if (start_ == JobStart::rebake)
        for (std::size_t region = 0; fs::remove(region_file(checkpoint_folder(job_.out), region), code);) ++region;
    print_summary(*baker_, bake_);
    fmt::print("{}\n", shown.string());
    return Done{};
}

}  // namespace

Status run_job(const BakeJob& job, JobStart start, std::span<const fs::path> shards) {
    const StopOnInterrupt stop;
    JobRun run(job, start, stop.flag());
    Status status = run.prepare();
    if (!status) return status;
    status = run.bake(shards);
    const bool part = job.bake.shard.count > 1;
    if (status && !part) status = run.finish();
    if (status && !part) status = run.write();
    if (stop.flag() && !status) return stopped(job.out, start);
    if (status && part)
        fmt::print("part {} of {} is done: {}\n", job.bake.shard.index, job.bake.shard.count, job.out.string());
    return status;
}

}  // namespace lobelia::cli
