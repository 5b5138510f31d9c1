// The course of a job, from the scene's file to the finished folder.
#include "cli/bake_job.h"

#include <fmt/format.h>

#include <csignal>

#include "baker/merge.h"
#include "baker/output/bake_folder.h"
#include "baker/preflight.h"
#include "baker/sites.h"
#include "cli/common.h"
#include "report/bake_page.h"

namespace lobelia::cli {
namespace {

namespace fs = std::filesystem;

/// Set by Ctrl-C; a signal handler can reach nothing else.
std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free);

/// While it lives, the first Ctrl-C asks the work to stop, and a second one ends the program.
class StopOnInterrupt {
  public:
    StopOnInterrupt() {
        interrupted = false;
        previous_ = std::signal(SIGINT, [](int) {
            interrupted = true;
            std::signal(SIGINT, SIG_DFL);
        });
    }
    ~StopOnInterrupt() { std::signal(SIGINT, previous_); }
    StopOnInterrupt(const StopOnInterrupt&) = delete;
    StopOnInterrupt& operator=(const StopOnInterrupt&) = delete;

  private:
    void (*previous_)(int) = SIG_DFL;
};

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
    if (bake.pages.size() != fresh.size() || layout.channels() != baker.layout().channels() ||
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
    const Codec* codec = baker.codec();
    const auto integrals = codec == nullptr ? std::vector<double>() : codec->basis().integrals();
    const Domain domain = codec == nullptr ? Domain::hemisphere : codec->basis().domain();
    denoise(pages, baker.layout(), guides, integrals, solid_angle(domain));
}

void print_summary(const Baker& baker, const Bake& bake) {
    const BakeStatistics& s = baker.statistics();
    fmt::print("{} texels on {} page{} of {}x{}, {} samples each\n", s.texels, bake.pages.size(),
               bake.pages.size() == 1 ? "" : "s", baker.atlas().width(), baker.atlas().height(), s.samples);
    fmt::print("{:.1f} million rays in {:.2f} s, {:.1f} Mray/s\n", static_cast<double>(s.rays) * 1e-6, s.seconds,
               s.seconds > 0 ? static_cast<double>(s.rays) * 1e-6 / s.seconds : 0);
    fmt::print("standard error of E {:.2f} %, leaks {:.2f} %, invalid texels {}\n", 100 * s.mean_error,
               100 * s.back_face_share, s.invalid_texels);
    if (baker.codec() != nullptr)
        fmt::print("E by the codec off by {:.2f} %, negative {:.2f} %, ringing {:.2f} %\n", 100 * s.codec_error,
                   100 * s.negative_share, 100 * s.ringing);
    if (bake.probes) fmt::print("{} probes\n", bake.probes->size());
}

/// Without a rate there is no estimate of the time, and no ray is traced.
Preflight preflight_of(const Baker& baker, std::optional<TraceRate> rate = {}) {
    PreflightOptions options;
    options.state_bytes = baker.sites().bytes();
    options.channels = baker.layout().channels();
    options.samples = baker.options().samples;
    options.rate = rate;
    return preflight(baker.atlas(), baker.texels(), options);
}

/// The pages' charts and what is wrong with them, as pictures.
Status write_preflight(const Preflight& checked, const Baker& baker, const fs::path& out) {
    std::vector<std::string> pictures;
    for (std::size_t page = 0; page < checked.pages; ++page) {
        auto png = encode_png(preflight_picture(checked, baker.atlas(), baker.texels(), page));
        if (!png) return png.error();
        pictures.push_back(std::move(*png));
    }
    std::vector<FileContent> files;
    for (std::size_t page = 0; page < pictures.size(); ++page)
        files.push_back({out / fmt::format("preflight-{}.png", page), pictures[page]});
    return write_into_folder(out, files);
}

Image to_image(const Image8& picture) {
    Image image(picture.width, picture.height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const std::uint8_t* rgb = &picture.rgb[3 * i];
        image.pixels[i] =
            Rgb{static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])} * (1.0f / 255);
    }
    return image;
}

/// bake.html: nothing where Ctrl-C was pressed while its pictures were made.
Result<std::string> make_page(const Scene& scene, const Baker& baker, const Bake& bake, const Preflight& checked,
                              std::span<const std::string> warnings, const RenderOptions& pictures) {
    BakePage page = bake_page_of(scene, baker, bake);
    page.warnings.assign(warnings.begin(), warnings.end());
    for (const auto& warning : lobelia::warnings(checked, scene))
        page.checks.push_back({PreflightCheck::Level::warning, "preflight", warning});
    if (page.checks.empty())
        page.checks.push_back({PreflightCheck::Level::good, "preflight", "Nothing to mend in the lightmap UVs."});
    constexpr std::size_t most_side = 1024;
    for (std::size_t p = 0; p < checked.pages; ++p)
        page.preflight_pictures.push_back(
            {fmt::format("page {}", p),
             to_image(preflight_picture(checked, baker.atlas(), baker.texels(), p, most_side))});
    auto views = render_views(scene, page.light, baker.options().paths, pictures);
    if (!views) return std::string();
    page.views = std::move(*views);
    return bake_html(page);
}

/// What Ctrl-C leaves: the line that says how to go on, and the exit that shells expect.
Status stopped(const fs::path& out) {
    complain(fmt::format("lobelia: stopped; go on with: lobelia bake --resume -o {}", out.string()));
    std::signal(SIGINT, SIG_DFL);
    std::raise(SIGINT);
    return Error{"stopped"};
}

}  // namespace

Status preflight_job(const BakeJob& job) {
    if (auto status = check_folder(job.out); !status) return status;
    auto loaded = load_scene(job.scene);
    if (!loaded) return loaded.error();
    for (const auto& warning : loaded->warnings) complain("lobelia: warning: " + warning);
    const auto baker = Baker::make(loaded->scene, job.bake);
    if (!baker) return baker.error();
    const Preflight checked =
        preflight_of(**baker, measure_rate((*baker)->atlas(), (*baker)->texels(), (*baker)->tracer()));
    if (auto status = write_preflight(checked, **baker, job.out); !status) return status;
    fmt::print("{}", to_text(checked, loaded->scene));
    return Done{};
}

Status run_job(const BakeJob& job, JobStart start, std::span<const fs::path> shards) {
    // Everything that is cheap to refuse, first.
    if (auto status = check_folder(job.out); !status) return status;
    auto loaded = load_scene(job.scene);
    if (!loaded) return loaded.error();
    for (const auto& warning : loaded->warnings) complain("lobelia: warning: " + warning);
    auto made = Baker::make(loaded->scene, job.bake);
    if (!made) return made.error();
    Baker& baker = **made;
    if (!baker.tracer().has_light()) complain("lobelia: warning: the scene has no light; everything will be black");
    if (job.probes.spacing > 0)
        if (auto status = check(job.probes, baker.tracer().world()); !status) return status;

    const Preflight checked = preflight_of(baker);
    std::vector<std::string> said = loaded->warnings;
    for (const auto& warning : warnings(checked, loaded->scene)) {
        complain("lobelia: warning: " + warning);
        said.push_back(warning);
    }

    // Bake.
    const StopOnInterrupt stop;
    if (start == JobStart::merged)
        if (auto status = merge_shards(baker, shards); !status) return status;
    if (start != JobStart::rebake)
        if (auto status = save_job(job); !status) return status;
    const bool from_nothing = start == JobStart::fresh || start == JobStart::rebake;
    auto status =
        baker.run(from_nothing ? Baker::Start::fresh : Baker::Start::resume, interrupted, progress_line("baking"));
    if (!status && interrupted) return stopped(job.out);
    if (!status) return status;
    if (job.bake.shard.count > 1) {
        fmt::print("part {} of {} is done: {}\n", job.bake.shard.index, job.bake.shard.count, job.out.string());
        return Done{};
    }

    // Finish, and put the files together.
    Bake bake;
    BakeOptions options = job.bake;
    options.frame = baker.in_tangent_frame() ? Frame::tangent : Frame::world;
    bake.manifest = make_manifest(loaded->scene, baker.atlas(), options, baker.statistics());
    bake.manifest.precision = job.precision;
    std::vector<Page>& pages = baker.pages();
    Guides guides = make_guides(baker.atlas(), map_texels(baker.atlas()));
    denoise_if(job.finish.denoise, pages, baker, guides);
    if (start == JobStart::rebake) {
        auto there = read_bake(job.out);
        if (!there) return there.error();
        if (status = put_among(*there, baker, pages); !status) return status;
        bake.probes = std::move(there->probes);
    }
    if (job.finish.seams == Switch::on) close_seams(pages, baker.layout(), baker.atlas());
    if (job.finish.dilate == Switch::on) dilate(pages);
    if (job.probes.spacing > 0 && start != JobStart::rebake) {
        auto probes = bake_probes(baker.tracer(), job.probes, job.bake.threads, interrupted, progress_line("probes"));
        if (!probes && interrupted) return stopped(job.out);
        if (!probes) return probes.error();
        bake.probes = std::move(*probes);
    }
    bake.pages = std::move(pages);
    bake.normals = std::move(guides.normal);
    std::string page;
    if (job.page) {
        RenderOptions pictures;
        pictures.threads = job.bake.threads;
        pictures.width = job.picture_width;
        pictures.height = job.picture_height;
        pictures.samples = job.picture_samples;
        pictures.stop = &interrupted;
        pictures.progress = [bar = progress_bar()](double done) {
            if (bar) bar(done);
        };
        auto made_page = make_page(loaded->scene, baker, bake, checked, said, pictures);
        if (!made_page) return made_page.error();
        if (interrupted) return stopped(job.out);
        page = std::move(*made_page);
    }
    if (status = write_bake(job.out, bake, {.scene = &loaded->scene}); !status) return status;
    if (job.page)
        if (status = write_file_atomically(job.out / "bake.html", page); !status) return status;
    print_summary(baker, bake);
    fmt::print("{}\n", (job.out / (job.page ? "bake.html" : "bake.json")).string());
    return Done{};
}

}  // namespace lobelia::cli
