// What a job shows: its lightmap UVs before the bake, and the page after it.
#include <fmt/format.h>

#include "bake/gather/sites.h"
#include "bake/write/page_textures.h"
#include "cli/bake_job.h"
#include "cli/common.h"
#include "report/bake_report.h"

namespace lobelia::cli {
namespace {

namespace fs = std::filesystem;

/// The pages' charts and what is wrong with them, as pictures; prints where they are.
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
    if (auto status = write_into_folder(out, files); !status) return status;
    for (const FileContent& file : files) fmt::print("{}\n", file.path.string());
    return Done{};
}

}  // namespace

Preflight preflight_of(const Baker& baker, std::optional<TraceRate> rate) {
    PreflightOptions options;
    options.state_bytes = baker.sites().bytes();
    options.channels = baker.layout().channels();
    options.samples = baker.options().samples;
    options.rate = rate;
    return preflight(baker.atlas(), baker.texels(), options);
}

Result<std::string> job_page(const BakeJob& job, const Scene& scene, const Baker& baker, const Bake& bake,
                             const Preflight& checked, const std::atomic<bool>& stop) {
    BakeReport page = bake_report_of(scene, baker, bake);
    page.warnings = bake.manifest.warnings;
    add_preflight(page, checked, scene, baker.atlas(), baker.texels());

    RenderOptions pictures;
    pictures.threads = job.bake.threads;
    pictures.width = job.picture_width;
    pictures.height = job.picture_height;
    pictures.samples = job.picture_samples;
    pictures.stop = &stop;
    pictures.progress = progress_bar();
    auto views = render_views(scene, page.light, baker.options().paths, pictures);
    if (!views) return Error{"stopped"};
    page.views = std::move(*views);
    return bake_html(page);
}

Status preflight_job(const BakeJob& job) {
    if (auto status = check_folder(job.out); !status) return status;
    if (const auto textures = PageTextures::make(job.bake.codec, job.storages); !textures) return textures.error();
    auto loaded = load_scene_to_bake(job.scene);
    if (!loaded) return loaded.error();
    for (const auto& warning : loaded->warnings) complain("lobelia: warning: " + warning);
    const auto baker = Baker::make(loaded->scene, job.bake);
    if (!baker) return baker.error();
    const Preflight checked =
        preflight_of(**baker, measure_rate((*baker)->atlas(), (*baker)->texels(), (*baker)->tracer()));
    fmt::print("{}", to_text(checked, loaded->scene));
    return write_preflight(checked, **baker, job.out);
}

}  // namespace lobelia::cli
