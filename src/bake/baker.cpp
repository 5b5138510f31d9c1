// The bake's course: plan, passes over tiles, checkpoints, solving onto pages.
#include "bake/baker.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <chrono>
#include <cmath>
#include <mutex>
#include <thread>

#include "bake/gather/sites.h"
#include "bake/place/texels.h"
#include "bake/session/checkpoint.h"
#include "bake/session/plan.h"
#include "bake/solve/solve.h"
#include "scene/scene_hash.h"

namespace lobelia {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

Site to_site(const Texel& texel, const CoveredTexel& at, const Atlas& atlas) {
    static_assert(Site::k_most_positions == k_most_positions);
    Site site;
    site.positions = texel.positions;
    site.position_count = texel.position_count;
    site.normal = texel.normal;
    site.buried = texel.buried;
    site.key = static_cast<std::uint32_t>((at.page * atlas.height() + at.y) * atlas.width() + at.x);
    return site;
}

/// Only the texels of one object; tiles that have none vanish.
TexelMap only_of(const TexelMap& map, const World& world, std::uint32_t object) {
    TexelMap result;
    for (std::size_t tile = 0; tile + 1 < map.first_of_tile.size(); ++tile) {
        const std::size_t before = result.texels.size();
        for (std::uint32_t i = map.first_of_tile[tile]; i < map.first_of_tile[tile + 1]; ++i) {
            if (world.object[map.triangle[i]] != object) continue;
            result.texels.push_back(map.texels[i]);
            result.triangle.push_back(map.triangle[i]);
        }
        if (result.texels.size() > before) result.first_of_tile.push_back(static_cast<std::uint32_t>(before));
    }
    result.first_of_tile.push_back(static_cast<std::uint32_t>(result.texels.size()));
    return result;
}

/// The one object of that name, which must have lightmap UVs.
Result<std::uint32_t> object_called(const World& world, const std::string& name) {
    const auto found = std::find(world.names.begin(), world.names.end(), name);
    if (found == world.names.end())
        return Error{"no object is called \"" + name + "\"" + nearest_names(name, world.names)};
    if (const auto count = std::count(found, world.names.end(), name); count > 1)
        return Error{
            fmt::format("{} objects are called \"{}\"; only a name of its own says which is meant", count, name)};
    const auto object = static_cast<std::uint32_t>(found - world.names.begin());
    if (world.has_lightmap_uv[object] == 0)
        return Error{"object \"" + name + "\" has no lightmap UVs and is not baked"};
    return object;
}

}  // namespace

struct Baker::Implementation {
    const Scene* scene = nullptr;
    BakeOptions options;
    World world;
    Atlas atlas;
    TexelMap map;
    std::optional<Codec> codec;
    std::unique_ptr<PathTracer> tracer;
    std::optional<SiteLayout> layout;
    BakePlan plan;
    std::uint64_t hash = 0;
    std::vector<Page> pages;
    BakeStatistics statistics;
    SolveTotals totals;

    /// What one run has besides.
    struct Run {
        Run(const std::atomic<bool>& stop_flag, const BakeProgressSink& to) : stop(stop_flag), sink(to) {}
        const std::atomic<bool>& stop;
        const BakeProgressSink& sink;
        Clock::time_point start = Clock::now();
        std::uint64_t passes_before = 0, passes_all = 0;
        std::uint64_t tiles_done = 0, tiles_all = 0;
        std::uint64_t rays = 0;
        double error = 0;
        std::mutex mutex;
        Clock::time_point shown = start;
    };

    [[nodiscard]] const Encoder* encoder() const { return codec ? codec->encoder().get() : nullptr; }
    /// Whose coefficients the pages hold.
    [[nodiscard]] const Encoder* page_encoder() const {
        if (!codec) return nullptr;
        const FittedBasis* fitted = codec->basis().fitted();
        return fitted != nullptr && fitted->is_continuous() ? &encoder()->accumulating() : encoder();
    }
    [[nodiscard]] bool in_tangent_frame() const {
        return !codec || codec->basis().domain() == Domain::hemisphere || options.frame == Frame::tangent;
    }
    [[nodiscard]] PassOptions pass_options(std::uint32_t pass) const {
        PassOptions result;
        result.gather.directions = options.directions;
        if (codec && codec->basis().domain() == Domain::sphere) result.gather.dark_below = Switch::on;
        result.samples = {pass * options.samples_per_pass, options.samples_per_pass};
        result.in_tangent_frame = in_tangent_frame();
        result.target_error = options.target_error;
        return result;
    }

    [[nodiscard]] PageLayout page_layout() const {
        return {page_encoder() == nullptr ? 0 : page_encoder()->basis().size()};
    }
    [[nodiscard]] Status lay_out();
    [[nodiscard]] std::vector<Site> make_sites(std::span<const std::uint32_t> texels) const;
    [[nodiscard]] Result<RegionStates> states_of(std::size_t region, std::span<const std::uint32_t> texels,
                                                 Start start);
    [[nodiscard]] Status run_region(std::size_t region, Start start, Run& run);
    void run_pass(std::span<const Site> sites, std::span<const std::uint32_t> first_of_tile, RegionStates& states,
                  std::uint32_t pass, Run& run) const;
    void report(Run& run, std::uint32_t pass) const;
    [[nodiscard]] double error_of(const RegionStates& states) const;
};

std::vector<Site> Baker::Implementation::make_sites(std::span<const std::uint32_t> texels) const {
    std::vector<Site> sites(texels.size());
    constexpr std::size_t grain = 1024;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, texels.size(), grain), [&](const auto& range) {
        // Texels of a region come in runs of consecutive ones.
        std::vector<Texel> made;
        for (std::size_t i = range.begin(); i < range.end();) {
            std::size_t end = i + 1;
            while (end < range.end() && texels[end] == texels[end - 1] + 1) ++end;
            make_texels(atlas, map, texels[i], texels[end - 1] + 1, *tracer, options.push_out, made);
            for (std::size_t k = i; k < end; ++k) sites[k] = to_site(made[k - i], map.texels[texels[k]], atlas);
            i = end;
        }
    });
    return sites;
}

Result<RegionStates> Baker::Implementation::states_of(std::size_t region, std::span<const std::uint32_t> texels,
                                                      Start start) {
    RegionStates fresh(texels.size(), layout->floats());
    fresh.header.bake = hash;
    fresh.header.texels = hash_of_texels(texels);
    fresh.header.first_pass = fresh.header.end_pass = plan.first_pass;
    fresh.header.samples_per_pass = options.samples_per_pass;
    fresh.header.shard_by = static_cast<std::uint32_t>(options.shard.by);
    fresh.header.shard_index = options.shard.index;
    fresh.header.shard_count = options.shard.count;
    fresh.header.first_place = plan.regions[region].first;
    fresh.header.end_place = plan.regions[region].end;
    if (options.checkpoint.empty()) return fresh;

    const auto path = region_file(options.checkpoint, region);
    std::error_code code;
    if (!std::filesystem::exists(path, code)) return fresh;
    if (start == Start::fresh)
        return Error{path.string() + ": is the checkpoint of an earlier bake; continue it with --resume, or remove it"};
    auto kept = RegionStates::read(path);
    if (!kept) return kept.error();
    const RegionHeader &is = kept->header, &wanted = fresh.header;
    if (is.bake != wanted.bake)
        return Error{path.string() +
                     ": belongs to another scene or other options; bake into another folder, or remove it"};
    if (is.texels != wanted.texels || is.sites != wanted.sites || is.floats != wanted.floats ||
        is.samples_per_pass != wanted.samples_per_pass || is.first_pass != wanted.first_pass)
        return Error{path.string() +
                     ": was made with another --memory, --shard or --samples-per-pass; use the same again"};
    return kept;
}

void Baker::Implementation::run_pass(std::span<const Site> sites, std::span<const std::uint32_t> first_of_tile,
                                     RegionStates& states, std::uint32_t pass, Run& run) const {
    const PassOptions pass_of = pass_options(pass);
    tbb::enumerable_thread_specific<SiteWorker> workers([&] { return SiteWorker(*tracer); });
    tbb::parallel_for(std::size_t{0}, first_of_tile.size() - 1, [&](std::size_t tile) {
        if (run.stop.load(std::memory_order_relaxed)) return;
        const std::size_t begin = first_of_tile[tile], count = first_of_tile[tile + 1] - begin;
        SiteWorker& worker = workers.local();
        const std::uint64_t before = worker.rays();
        worker.run(sites.subspan(begin, count), *layout, encoder(),
                   states.states().subspan(begin * layout->floats(), count * layout->floats()), pass_of);
        const std::lock_guard lock(run.mutex);
        run.rays += worker.rays() - before;
        ++run.tiles_done;
        report(run, pass);
    });
    for (const SiteWorker& worker : workers) states.header.rays += worker.rays();
}

void Baker::Implementation::report(Run& run, std::uint32_t pass) const {
    if (!run.sink) return;
    const auto now = Clock::now();
    if (std::chrono::duration<double>(now - run.shown).count() < 0.1 && run.tiles_done < run.tiles_all) return;
    run.shown = now;
    BakeProgress progress;
    const double seconds = seconds_since(run.start);
    progress.done =
        static_cast<double>(run.tiles_done) / static_cast<double>(std::max<std::uint64_t>(1, run.tiles_all));
    progress.rays_per_second = static_cast<double>(run.rays) / std::max(1e-3, seconds);
    progress.seconds_left = progress.done > 0 ? seconds * (1 / progress.done - 1) : 0;
    progress.error = run.error;
    progress.pass = pass + 1 - plan.first_pass;
    progress.passes = plan.passes();
    run.sink(progress);
}

/// RMS of the standard errors over the mean of E, as the statistics have it in the end.
double Baker::Implementation::error_of(const RegionStates& states) const {
    double squared = 0, mean = 0, count = 0;
    for (std::size_t i = 0; i < states.header.sites; ++i) {
        const auto state = states.states().subspan(i * layout->floats(), layout->floats());
        const SiteSummary is = summary(layout->record(state), options.samples_per_pass);
        if (is.validity < 0.5f || !std::isfinite(is.error)) continue;
        squared += static_cast<double>(is.error) * is.error;
        mean += luminance(is.irradiance);
        count += 1;
    }
    return mean > 0 ? std::sqrt(squared / count) / (mean / count) : 0;
}

Status Baker::Implementation::run_region(std::size_t region, Start start, Run& run) {
    const std::vector<std::uint32_t> texels = plan.texels(map, region);
    auto loaded = states_of(region, texels, start);
    if (!loaded) return loaded.error();
    RegionStates& states = *loaded;
    const TileRange range = plan.regions[region];
    std::vector<std::uint32_t> first_of_tile = {0};
    for (std::uint32_t place = range.first; place < range.end; ++place)
        first_of_tile.push_back(first_of_tile.back() + map.first_of_tile[plan.tiles[place] + 1] -
                                map.first_of_tile[plan.tiles[place]]);
    run.tiles_done += std::uint64_t{states.header.end_pass - plan.first_pass} * (range.end - range.first);

    // Each region may take its share of the time.
    const double share = static_cast<double>(region + 1) / static_cast<double>(plan.regions.size());
    const auto out_of_time = [&] {
        return options.most_seconds && seconds_since(run.start) >= share * *options.most_seconds;
    };
    const std::vector<Site> sites = make_sites(texels);
    while (states.header.end_pass < plan.end_pass && !out_of_time()) {
        const auto pass_start = Clock::now();
        run_pass(sites, first_of_tile, states, states.header.end_pass, run);
        if (run.stop) return Error{"stopped"};
        if (run.sink) run.error = error_of(states);
        ++states.header.end_pass;
        states.header.seconds += seconds_since(pass_start);
        if (options.checkpoint.empty()) continue;
        if (auto status = states.write(region_file(options.checkpoint, region)); !status) return status;
    }

    statistics.rays += states.header.rays;
    statistics.seconds += states.header.seconds;
    statistics.samples =
        std::max(statistics.samples, (states.header.end_pass - plan.first_pass) * options.samples_per_pass);
    const SolveOptions solve{codec ? &*codec : nullptr, page_encoder(), options.samples_per_pass, in_tangent_frame()};
    solve_onto(pages, map, texels, states.states(), *layout, solve, sites, atlas, totals);
    return Done{};
}

/// Atlas, texels and plan.
Status Baker::Implementation::lay_out() {
    world = make_world(*scene);
    auto made = Atlas::make(world, options.atlas);
    if (!made) return made.error();
    atlas = std::move(*made);
    map = map_texels(atlas);
    if (options.only_object) {
        const auto object = object_called(world, *options.only_object);
        if (!object) return object.error();
        map = only_of(map, world, *object);
    }
    if (map.texels.empty()) return Error{"no texel is covered by any triangle; are the lightmap UVs degenerate?"};

    // Memory: pages and the scene are always there, states and sites as far as they fit.
    layout.emplace(encoder());
    const std::size_t texels = atlas.width() * atlas.height() * atlas.pages();
    // The scene and the world's vertices, Embree's tree, shading data: about 500 as measured on a million triangles.
    constexpr std::size_t bytes_per_triangle = 600, bytes_of_program = 64 << 20;
    const std::size_t always = texels * (page_layout().channels() * sizeof(float) + 2 * sizeof(std::uint32_t)) +
                               map.texels.size() * (sizeof(CoveredTexel) + sizeof(std::uint32_t)) +
                               world.triangles.size() * bytes_per_triangle + bytes_of_program;
    auto planned = make_plan(map, options, layout->bytes() + sizeof(Site) + sizeof(std::uint32_t), always);
    if (!planned) return planned.error();
    plan = std::move(*planned);
    return Done{};
}

Baker::Baker() : implementation_(std::make_unique<Implementation>()) {}
Baker::~Baker() = default;

Result<std::unique_ptr<Baker>> Baker::make(const Scene& scene, const BakeOptions& options) {
    std::unique_ptr<Baker> bake(new Baker);
    Implementation& self = *bake->implementation_;
    self.scene = &scene;
    self.options = options;
    if (!options.codec.empty()) {
        auto codec = make_codec(options.codec);
        if (!codec) return codec.error();
        self.codec.emplace(std::move(*codec));
        if (options.shard.by == Shard::By::samples && self.codec->encoder()->merging() != Merging::exact)
            return Error{"codec \"" + options.codec +
                         "\": its encoder learns sample by sample, and parts of it do not add up; "
                         "divide the bake by tiles, or use an encoder of moments"};
    }
    if (options.shard.by == Shard::By::samples && options.target_error)
        return Error{"--target-error does not go with shards of samples: no shard knows the others' errors"};

    if (auto status = self.lay_out(); !status) return status.error();
    self.hash = state_hash(scene, options);
    self.tracer = std::make_unique<PathTracer>(scene, self.world, options.paths);
    return bake;
}

Status Baker::run(Start start, const std::atomic<bool>& stop, const BakeProgressSink& progress) {
    Implementation& self = *implementation_;
    self.statistics = {};
    self.totals = {};
    self.statistics.texels = self.map.texels.size();
    self.pages.assign(self.atlas.pages(), Page(self.atlas.width(), self.atlas.height(), layout().channels()));
    Implementation::Run run(stop, progress);
    run.tiles_all = std::uint64_t{self.plan.passes()} * self.plan.tiles.size();

    Status status = Done{};
    tbb::task_arena arena(self.options.threads == 0 ? tbb::task_arena::automatic
                                                    : static_cast<int>(self.options.threads));
    arena.execute([&] {
        for (std::size_t region = 0; region < self.plan.regions.size() && status; ++region)
            status = self.run_region(region, start, run);
    });
    if (!status) return status;
    self.totals.finish(self.statistics);
    return Done{};
}

const BakeOptions& Baker::options() const { return implementation_->options; }
const Atlas& Baker::atlas() const { return implementation_->atlas; }
const TexelMap& Baker::texels() const { return implementation_->map; }
const BakePlan& Baker::plan() const { return implementation_->plan; }
const SiteLayout& Baker::sites() const { return *implementation_->layout; }
std::uint64_t Baker::hash() const { return implementation_->hash; }
const PathTracer& Baker::tracer() const { return *implementation_->tracer; }
const Codec* Baker::codec() const { return implementation_->codec ? &*implementation_->codec : nullptr; }
PageLayout Baker::layout() const { return implementation_->page_layout(); }
const Basis* Baker::page_basis() const {
    const Encoder* encoder = implementation_->page_encoder();
    return encoder == nullptr ? nullptr : &encoder->basis();
}
bool Baker::in_tangent_frame() const { return implementation_->in_tangent_frame(); }
std::vector<Page>& Baker::pages() { return implementation_->pages; }
const BakeStatistics& Baker::statistics() const { return implementation_->statistics; }

std::uint64_t state_hash(const Scene& scene, const BakeOptions& o) {
    // As text, so that nothing depends on how structures are padded.
    const auto& a = o.atlas;
    const auto& p = o.paths;
    const std::string text =
        fmt::format("{:x} {} {} | {} {} {} {} {} | {} {} {} {} {} {} | {} {} {} {}", scene_hash(scene), o.codec,
                    static_cast<int>(o.frame), a.width, a.height, a.texels_per_metre.value_or(0), a.padding,
                    static_cast<int>(a.layout), p.bounces, p.seed, static_cast<int>(p.next_event),
                    static_cast<int>(p.environment_table), static_cast<int>(p.roulette), static_cast<int>(p.sun_size),
                    static_cast<int>(o.directions), static_cast<int>(o.push_out), o.target_error.value_or(0),
                    o.only_object.value_or(""));
    std::uint64_t hash = 0xcbf29ce484222325;  // FNV-1a
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
    return hash;
}

}  // namespace lobelia
