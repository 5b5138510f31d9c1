// The spine of the bake: place, gather, solve, finish, write.
#include "lobelia/bake.h"

#include <fmt/format.h>

#include "bake/check_job.h"
#include "bake/finish/finish.h"
#include "bake/finish/steps.h"
#include "bake/place/objects.h"
#include "bake/preflight/preflight.h"
#include "bake/probes/bake_probes.h"
#include "bake/session/continuation.h"
#include "bake/session/job_file.h"
#include "bake/session/merge.h"
#include "bake/session/regions.h"
#include "bake/solve/solve.h"
#include "bake/with_threads.h"
#include "bake/write/bake_folder.h"
#include "bake/write/lightmap_exports.h"
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

Status check_textures(const BakeJob& job) {
    if (const auto exports = find_lightmap_exports(job.exports); !exports) return exports.error();
    const auto textures =
        PageTextures::make(job.bake.codec, job.textures, {job.bake.atlas.width, job.bake.atlas.height});
    return textures ? Status(Done{}) : textures.error();
}

/// Lays out pages, texels and probes; checks everything that is cheap to refuse, and warns.
Result<BakeWork> place(const Scene& scene, const BakeJob& job, const BakeSession& session) {
    if (auto status = check_textures(job); !status) return status.error();
    auto setup = BakeSetup::make(scene, job.bake, session.stop);
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
    work.bake.preflight = preflight(*work.setup, job.textures.levels, session.stop);
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
    InstructionSets instruction_sets = 0;
    for (std::size_t number = 0; number < setup.plan.regions.size(); ++number) {
        const auto region = gatherer.gather(number);
        if (!region) return region.error();
        solve_onto(work.bake.pages, setup.atlas, setup.map,
                   {region->texels, region->receivers, region->states.states(), session.stop}, setup.encoding,
                   setup.options.samples_per_pass, totals);
        const RegionHeader& header = region->states.header;
        instruction_sets = joined(instruction_sets, header.instruction_sets);
        statistics.rays += header.rays;
        statistics.seconds += header.seconds;
        statistics.samples =
            std::max(statistics.samples, (header.end_pass - setup.plan.first_pass) * setup.options.samples_per_pass);
    }
    totals.finish(statistics);
    if (are_several(instruction_sets)) warn(work.bake, session, several_sets_warning(instruction_sets));
    if (statistics.codec_error > k_useless_codec)
        warn(work.bake, session,
             fmt::format("codec irradiance error {:.0f} % RMS: encoder \"{}\" is unsuitable for this light; use "
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

/// Denoises the pages; `complete` may then add texels from elsewhere; closes seams, dilates, and fits the codec's
/// coefficients.
template <class Complete>
Status finish(BakeWork& work, const FinishOptions& steps, const BakeSession& session, const Complete& complete) {
    const BakeSetup& setup = *work.setup;
    std::vector<LightmapPage>& pages = work.bake.pages;
    std::vector<std::string>& taken = work.bake.manifest.finish;
    const StopFlag stop = session.stop;
    const TexelMap map = map_texels(setup.atlas, stop);
    Guides guides = make_guides(setup.atlas, map, stop);
    if (steps.denoise == Switch::on) {
        if (denoise_pages(pages, setup.encoding, guides, stop))
            taken.emplace_back("denoise");
        else
            warn(work.bake, session,
                 "not denoised: the coefficients of " + setup.encoding.codec()->name().basis +
                     " are not linear in the light");
    }
    if (auto status = complete(pages); !status) return status;
    const bool fitted = pages.front().planes.size() != setup.encoding.page_channels().count();
    if (steps.seams == Switch::on) {
        if (fitted) {
            warn(work.bake, session,
                 "seams around the object are not closed: the coefficients of " + setup.encoding.codec()->name().basis +
                     " are not linear in the light");
        } else {
            SeamSurroundings around{setup.tracer.get(), {}};
            if (setup.options.push_out == Switch::on)
                around.displaced = displaced_texels(setup.atlas, map, *setup.tracer, stop);
            SeamOptions options;
            options.stop = stop;
            close_seams(pages, setup.encoding.page_channels(), setup.atlas, options, around);
            taken.emplace_back("seams");
        }
    }
    if (steps.dilate == Switch::on) {
        DilateOptions options;
        options.stop = stop;
        dilate(pages, options);
        taken.emplace_back("dilate");
    }
    if (!fitted) fit_codec(pages, setup.encoding, stop);
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

/// Writes the bake into the session's folder; `prepare(FilesTogether&)` adds what is to change there in the same step.
template <class Prepare>
Status write(BakeWork& work, const BakeJob& job, const BakeSession& session, const Prepare& prepare) {
    if (session.folder.empty()) return Done{};
    FilesTogether files(session.lock, session.stop);
    if (Status status = prepare(files); !status) return status;
    auto manifest = write_bake(std::move(files), work.bake, {job.textures, work.setup->scene, job.exports});
    if (!manifest) return manifest.error();
    for (std::size_t i = work.bake.manifest.warnings.size(); i < manifest->warnings.size() && session.warn; ++i)
        session.warn(manifest->warnings[i]);
    work.bake.manifest = *std::move(manifest);
    return Done{};
}

/// Removes the states, which do not hold the texels of an object baked again, and notes that in the job.
Status drop_states(FilesTogether& files, const BakeJob& job, std::string_view object) {
    if (!holds_job(files.folder())) return Done{};
    const auto earlier = read_kept_job(files.folder());
    if (!earlier) return earlier.error();
    KeptJob kept{job, earlier->rebaked.value_or(std::vector<std::string>())};
    kept.rebaked->emplace_back(object);
    for (const std::string& states : region_names(files.folder())) files.remove(states);
    return files.add_text(k_job_name, to_json_text(kept));
}

/// Checks the job, and runs `work` with its number of threads; an error if it is stopped.
template <class Work>
auto run_checked(const BakeJob& job, const Work& work) -> decltype(work()) {
    if (auto status = check(job); !status) return status.error();
    return with_threads(job.bake.threads, [&] { return unless_stopped(work); });
}

/// Returns the session with its folder locked, if it has one.
Result<BakeSession> locked(const BakeSession& session) {
    BakeSession holder = session;
    if (session.folder.empty() || session.lock) return holder;
    if (auto status = check_folder(session.folder); !status) return status.error();
    auto lock = lock_folder(session.folder);
    if (!lock) return lock.error();
    holder.lock = *std::move(lock);
    return holder;
}

/// Checks what the folder holds against the bake, before anything there is changed; then keeps the job there.
Status begin(const BakeWork& work, const BakeJob& job, const BakeSession& session) {
    if (session.folder.empty()) return Done{};
    if (session.start == BakeSession::Start::resume)
        if (auto status = check_continuation(*work.setup, session.folder); !status) return status;
    return save_job(session.folder, job);
}

/// Gathers light with a checkpoint after each pass, finishes the pages and writes the folder.
Result<Bake> run(const Scene& scene, const BakeJob& job, const BakeSession& session) {
    if (session.start == BakeSession::Start::fresh && !session.folder.empty() && !region_names(session.folder).empty())
        return earlier_checkpoint(session.folder);

    // Place texels on pages and in the world.
    auto work = place(scene, job, session);
    if (!work) return work.error();

    // Gather light for each texel and solve for its coefficients.
    const fs::path checkpoint = session.folder.empty() ? fs::path() : checkpoint_folder(session.folder);
    Status status = begin(*work, job, session);
    if (status) status = gather_and_solve(*work, session, checkpoint);
    if (!status) return status.error();
    if (job.bake.shard.count > 1) {
        // The states are all that a shard has.
        work->bake.pages.clear();
        return std::move(work->bake);
    }

    // Finish the pages, add probes, and write the folder.
    status = finish(*work, job.finish, session, [](auto&) -> Status { return Done{}; });
    if (status) status = add_probes(*work, job, session);
    if (status) status = write(*work, job, session, [](FilesTogether&) -> Status { return Done{}; });
    return status ? Result<Bake>(std::move(work->bake)) : status.error();
}

/// Puts the states of all shards and the job into the folder, in one step: from then on the bake can be resumed.
Status merge_into(const Scene& scene, const BakeJob& job, std::span<const fs::path> shards,
                  const BakeSession& session) {
    if (!region_names(session.folder).empty())
        return Error{
            fmt::format("{}: holds the states of a bake already; complete it: lobelia bake --resume -o {}; or "
                        "merge into another folder",
                        checkpoint_folder(session.folder).string(), session.folder.string())};
    const auto setup = BakeSetup::make(scene, job.bake, session.stop);
    if (!setup) return setup.error();
    FilesTogether files(session.lock, session.stop);
    Status status = merge_shards(**setup, shards, files);
    if (status) status = files.add_text(k_job_name, to_json_text(KeptJob{job, {}}));
    return status ? files.commit() : status;
}

}  // namespace

Result<Bake> bake(const Scene& scene, const BakeJob& job, BakeSession& session) {
    return run_checked(job, [&]() -> Result<Bake> {
        const auto holder = locked(session);
        return holder ? run(scene, job, *holder) : holder.error();
    });
}

Result<Bake> merge_bake(const Scene& scene, const BakeJob& job, std::span<const fs::path> shards,
                        BakeSession& session) {
    return run_checked(job, [&]() -> Result<Bake> {
        auto holder = locked(session);
        if (!holder) return holder.error();
        if (auto status = merge_into(scene, job, shards, *holder); !status) return status.error();
        // Every pass is there now.
        holder->start = BakeSession::Start::resume;
        return run(scene, job, *holder);
    });
}

Result<Bake> rebake_object(const Scene& scene, const BakeJob& job, std::string_view object, Bake there,
                           BakeSession& session) {
    if (!session.folder.empty())
        if (auto status = check_folder(session.folder); !status) return status.error();
    BakeJob of_object = job;
    of_object.bake.only_object = std::string(object);
    return run_checked(job, [&]() -> Result<Bake> {
        if (auto status = check_same_options(there.manifest, job); !status) return status.error();
        const auto holder = locked(session);
        if (!holder) return holder.error();

        // Place, gather and solve the texels of the object alone, without a checkpoint.
        auto work = place(scene, of_object, *holder);
        if (!work) return work.error();
        Status status = gather_and_solve(*work, *holder, {});
        if (!status) return status.error();

        // Finish them among the texels that are there, and write all of them.
        status = finish(*work, job.finish, *holder, [&](std::vector<LightmapPage>& pages) {
            fit_codec(pages, work->setup->encoding, session.stop);
            return fill_up_from(there, *work->setup, pages);
        });
        if (!status) return status.error();
        work->bake.probes = std::move(there.probes);
        work->bake.manifest.statistics = there.manifest.statistics;
        work->bake.manifest.options.only_object.reset();
        status = write(*work, job, *holder, [&](FilesTogether& files) { return drop_states(files, job, object); });
        return status ? Result<Bake>(std::move(work->bake)) : status.error();
    });
}

Result<Preflight> preflight(const Scene& scene, const BakeJob& job, const std::atomic<bool>* stop) {
    return run_checked(job, [&]() -> Result<Preflight> {
        if (auto status = check_textures(job); !status) return status.error();
        const auto setup = BakeSetup::make(scene, job.bake, stop);
        if (!setup) return setup.error();
        return preflight(**setup, job.textures.levels, stop,
                         measure_rate((*setup)->atlas, (*setup)->map, *(*setup)->tracer));
    });
}

}  // namespace lobelia
