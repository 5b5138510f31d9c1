// The spine of the bake: place, gather, solve, finish, write.
#include "lobelia/bake.h"

#include <fmt/format.h>

#include "bake/finish/finish.h"
#include "bake/finish/steps.h"
#include "bake/place/objects.h"
#include "bake/preflight/preflight.h"
#include "bake/probes/bake_probes.h"
#include "bake/session/merge.h"
#include "bake/session/regions.h"
#include "bake/solve/solve.h"
#include "bake/with_threads.h"
#include "bake/write/job_file.h"
#include "bake/write/manifest.h"
#include "bake/write/page_textures.h"
#include "io/staged_file.h"

namespace lobelia {
namespace {

namespace fs = std::filesystem;

/// Error of E by the codec over the mean of E that no codec has unless its encoder fails.
constexpr double k_useless_codec = 2;

/// A bake under way: the scene's layout, and the result as far as it goes.
struct BakeWork {
    std::unique_ptr<const BakeSetup> setup;
    Bake bake;
};

void warn(Bake& bake, const BakeSession& session, const std::string& text) {
    bake.manifest.warnings.push_back(text);
    if (session.warn) session.warn(text);
}

/// Lays out pages, texels and probes; checks everything that is cheap to refuse, and warns.
Result<BakeWork> place(const Scene& scene, const BakeJob& job, const BakeSession& session) {
    if (const auto textures = PageTextures::make(job.bake.codec, job.storages); !textures) return textures.error();
    auto setup = BakeSetup::make(scene, job.bake);
    if (!setup) return setup.error();
    BakeWork work{*std::move(setup), {}};
    if (job.probes)
        if (auto status = check(*job.probes, work.setup->world); !status) return status.error();
    BakeOptions options = job.bake;
    options.frame = work.setup->encoding.frame();
    work.bake.manifest = make_manifest(scene, work.setup->atlas, options);
    work.bake.manifest.precision = job.precision;
    for (const std::string& warning : session.earlier_warnings) warn(work.bake, session, warning);
    if (!work.setup->tracer->has_light()) warn(work.bake, session, "the scene has no light; everything will be black");
    work.bake.preflight = preflight(*work.setup);
    for (const std::string& warning : warnings(*work.bake.preflight, scene)) warn(work.bake, session, warning);
    return work;
}

/// Gathers light and solves, region by region as the memory allows.
Status gather_and_solve(BakeWork& work, const BakeSession& session, const fs::path& checkpoint) {
    const BakeSetup& setup = *work.setup;
    BakeStatistics& statistics = work.bake.manifest.statistics;
    statistics.texels = setup.map.texels.size();
    work.bake.pages.assign(setup.atlas.pages(), LightmapPage(setup.atlas.width(), setup.atlas.height(),
                                                             setup.encoding.page_channels().count()));
    RegionGatherer gatherer(setup, session, checkpoint);
    SolveTotals totals;
    for (std::size_t number = 0; number < setup.plan.regions.size(); ++number) {
        const auto region = gatherer.gather(number);
        if (!region) return region.error();
        solve_onto(work.bake.pages, setup.atlas, setup.map,
                   {region->texels, region->receivers, region->states.states()}, setup.encoding,
                   setup.options.samples_per_pass, totals);
        const RegionHeader& header = region->states.header;
        statistics.rays += header.rays;
        statistics.seconds += header.seconds;
        statistics.samples =
            std::max(statistics.samples, (header.end_pass - setup.plan.first_pass) * setup.options.samples_per_pass);
    }
    totals.finish(statistics);
    if (statistics.codec_error > k_useless_codec)
        warn(work.bake, session,
             fmt::format("the codec's irradiance is off by {:.0f} % RMS: encoder \"{}\" does not suit this light; use "
                         "moments or least-squares",
                         100 * statistics.codec_error, setup.encoding.codec()->name().encoder));
    return Done{};
}

/// Replaces the texels of `fresh` that the setup does not cover by those of the finished bake.
Status fill_up_from(const Bake& finished, const BakeSetup& setup, std::vector<LightmapPage>& fresh) {
    std::vector<LightmapPage> pages = finished.pages;
    if (pages.size() != fresh.size() || pages.front().planes.size() != fresh.front().planes.size() ||
        pages.front().size() != fresh.front().size())
        return Error{"the object cannot be baked again: the finished bake has pages of another number, size or codec"};
    for (const CoveredTexel& at : setup.map.texels) {
        LightmapPage &to = pages[at.page], &from = fresh[at.page];
        const std::size_t pixel = at.y * to.width + at.x;
        for (std::size_t k = 0; k < to.planes.size(); ++k) to.planes[k][pixel] = from.planes[k][pixel];
        to.chart[pixel] = from.chart[pixel];
        to.validity[pixel] = from.validity[pixel];
    }
    fresh = std::move(pages);
    return Done{};
}

/// Denoises the pages; `merge` may then complete them; closes seams, dilates, and fits the codec's coefficients.
template <class Complete>
Status finish(BakeWork& work, const FinishOptions& steps, const BakeSession& session, const Complete& complete) {
    const BakeSetup& setup = *work.setup;
    std::vector<LightmapPage>& pages = work.bake.pages;
    std::vector<std::string>& taken = work.bake.manifest.finish;
    const TexelMap map = map_texels(setup.atlas);
    Guides guides = make_guides(setup.atlas, map);
    if (steps.denoise == Switch::on) {
        if (denoise_pages(pages, setup.encoding, guides))
            taken.emplace_back("denoise");
        else
            warn(work.bake, session,
                 "not denoised: the coefficients of " + setup.encoding.codec()->name().basis +
                     " are not linear in the light");
    }
    if (auto status = complete(pages); !status) return status;
    const bool fitted = pages.front().planes.size() != setup.encoding.page_channels().count();
    if (steps.seams == Switch::on) {
        SeamSurroundings around{setup.tracer.get(), {}};
        if (setup.options.push_out == Switch::on) around.displaced = displaced_texels(setup.atlas, map, *setup.tracer);
        if (!fitted) close_seams(pages, setup.encoding.page_channels(), setup.atlas, {}, around);
        taken.emplace_back("seams");
    }
    if (steps.dilate == Switch::on) {
        dilate(pages);
        taken.emplace_back("dilate");
    }
    if (!fitted) fit_codec(pages, setup.encoding);
    work.bake.normals = std::move(guides.normal);
    return Done{};
}

Status add_probes(BakeWork& work, const BakeJob& job, const BakeSession& session) {
    if (!job.probes) return Done{};
    auto probes = bake_probes(*work.setup->tracer, *job.probes, session);
    if (!probes) return probes.error();
    work.bake.probes = *std::move(probes);
    return Done{};
}

Status write(BakeWork& work, const BakeJob& job, const BakeSession& session) {
    if (session.folder.empty()) return Done{};
    auto manifest = write_bake(session.folder, work.bake, {job.storages, work.setup->scene});
    if (!manifest) return manifest.error();
    for (std::size_t i = work.bake.manifest.warnings.size(); i < manifest->warnings.size() && session.warn; ++i)
        session.warn(manifest->warnings[i]);
    work.bake.manifest = *std::move(manifest);
    return Done{};
}

/// An error if the folder cannot be written to, or holds states that a fresh start would replace.
Status check_session(const BakeSession& session) {
    if (session.folder.empty()) return Done{};
    if (auto status = check_folder(session.folder); !status) return status;
    std::error_code code;
    const fs::path states = region_file(checkpoint_folder(session.folder), 0);
    if (session.start == BakeSession::Start::fresh && fs::exists(states, code)) return earlier_checkpoint(states);
    return Done{};
}

}  // namespace

Result<Bake> bake(const Scene& scene, const BakeJob& job, BakeSession& session) {
    if (auto status = check_session(session); !status) return status.error();
    return with_threads(job.bake.threads, [&]() -> Result<Bake> {
        // Place texels on pages and in the world.
        auto work = place(scene, job, session);
        if (!work) return work.error();

        // Gather light for each texel and solve for its coefficients, with a checkpoint after each pass.
        const fs::path checkpoint = session.folder.empty() ? fs::path() : checkpoint_folder(session.folder);
        Status status = checkpoint.empty() ? Done{} : save_job(checkpoint, job);
        if (status) status = gather_and_solve(*work, session, checkpoint);
        if (job.bake.shard.count > 1) work->bake.pages.clear();
        if (!status || job.bake.shard.count > 1) return status ? Result<Bake>(work->bake) : status.error();

        // Finish the pages, add probes, and write the folder.
        status = finish(*work, job.finish, session, [](auto&) -> Status { return Done{}; });
        if (status) status = add_probes(*work, job, session);
        if (status) status = write(*work, job, session);
        return status ? Result<Bake>(std::move(work->bake)) : status.error();
    });
}

Result<Bake> merge_bake(const Scene& scene, const BakeJob& job, std::span<const fs::path> shards,
                        BakeSession& session) {
    if (auto status = check_folder(session.folder); !status) return status.error();
    std::vector<fs::path> checkpoints;
    for (const fs::path& shard : shards) checkpoints.push_back(checkpoint_folder(shard));
    {
        const auto setup = BakeSetup::make(scene, job.bake);
        if (!setup) return setup.error();
        const Status status = merge_shards(**setup, checkpoints, checkpoint_folder(session.folder));
        if (!status) return status.error();
    }
    // Every pass is there now.
    session.start = BakeSession::Start::resume;
    return bake(scene, job, session);
}

Result<Bake> rebake_object(const Scene& scene, const BakeJob& job, std::string_view object, Bake there,
                           BakeSession& session) {
    BakeJob of_object = job;
    of_object.bake.only_object = std::string(object);
    return with_threads(job.bake.threads, [&]() -> Result<Bake> {
        // Place, gather and solve the texels of the object alone, without a checkpoint.
        auto work = place(scene, of_object, session);
        if (!work) return work.error();
        Status status = gather_and_solve(*work, session, {});
        if (!status) return status.error();

        // Finish them among the texels that are there, and write all of them.
        status = finish(*work, job.finish, session, [&](std::vector<LightmapPage>& pages) {
            fit_codec(pages, work->setup->encoding);
            return fill_up_from(there, *work->setup, pages);
        });
        if (!status) return status.error();
        work->bake.probes = std::move(there.probes);
        work->bake.manifest.statistics = there.manifest.statistics;
        work->bake.manifest.options.only_object.reset();
        if (status = write(*work, job, session); !status) return status.error();

        // Remove the states, which do not hold the new texels.
        std::error_code code;
        const fs::path states = checkpoint_folder(session.folder);
        for (std::size_t region = 0; fs::remove(region_file(states, region), code);) ++region;
        return std::move(work->bake);
    });
}

Result<Preflight> preflight(const Scene& scene, const BakeJob& job) {
    return with_threads(job.bake.threads, [&]() -> Result<Preflight> {
        if (const auto textures = PageTextures::make(job.bake.codec, job.storages); !textures) return textures.error();
        const auto setup = BakeSetup::make(scene, job.bake);
        if (!setup) return setup.error();
        return preflight(**setup, measure_rate((*setup)->atlas, (*setup)->map, *(*setup)->tracer));
    });
}

}  // namespace lobelia
