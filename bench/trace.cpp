// trace.*: rays traced and shaded, beside Embree's own rate of incoherent closest hits in the same scene and run.
#include "bench/trace.h"

#include <benchmark/benchmark.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <ctime>
#include <memory>

#include "bake/gather/gather.h"
#include "core/sample/directions.h"
#include "lobelia/sampling.h"
#include "scene/embedded.h"
#include "trace/rays.h"
#include "trace/surface.h"

namespace lobelia::bench {
namespace {

/// CPU time of this thread [s], so that other programs on the machine do not count.
double thread_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// A sphere of 2 steps^2 triangles, wrinkled so that rays from it are as incoherent as possible.
Mesh wrinkled_ball(std::uint32_t steps) {
    Mesh mesh;
    for (std::uint32_t j = 0; j <= steps; ++j)
        for (std::uint32_t i = 0; i <= steps; ++i) {
            const float u = static_cast<float>(i) / static_cast<float>(steps),
                        v = static_cast<float>(j) / static_cast<float>(steps);
            const float r = 1 + 0.1f * std::sin(60 * u * static_cast<float>(2 * k_pi)) * std::sin(50 * v);
            const Vec3 d = around_z(1 - 2 * v, u);
            mesh.positions.push_back(Vec3{d.x * r, 2.75f + d.z * r, d.y * r});
        }
    for (std::uint32_t j = 0; j < steps; ++j)
        for (std::uint32_t i = 0; i < steps; ++i) {
            const std::uint32_t a = j * (steps + 1) + i, b = a + 1, c = a + steps + 1, d = c + 1;
            mesh.triangles.push_back({a, d, b});
            mesh.triangles.push_back({a, c, d});
        }
    mesh.materials.assign(mesh.triangles.size(), 0);
    return mesh;
}

/// A scene with receivers spread evenly over its surfaces, and rays like those of paths in it.
struct Workplace {
    Scene scene;
    World world;
    PathTracer tracer;
    Surfaces surfaces;
    RayScene rays;
    std::vector<Receiver> receivers;
    std::vector<PathTracer::Ray> incoherent;

    explicit Workplace(Scene s)
        : scene(std::move(s)),
          world(make_world(scene)),
          tracer(scene, world),
          surfaces(scene, world),
          rays(world, surfaces.kinds(), surfaces) {
        place(48000);
        for (std::uint32_t i = 0; i < 100000; ++i) {
            const Receiver& r = receivers[mix(i, 1) % receivers.size()];
            incoherent.push_back({r.positions[0], Axes(r.normal).world(cosine_direction(pair(i, 0, 0, 1))), INFINITY});
        }
    }

    void place(std::uint32_t count) {
        std::vector<float> areas;
        for (std::uint32_t t = 0; t < surfaces.size(); ++t)
            areas.push_back(length(cross(surfaces.facet(t).edge_u, surfaces.facet(t).edge_v)));
        const AliasTable table(areas);
        for (std::uint32_t i = 0; i < count; ++i) {
            const Facet& f = surfaces.facet(static_cast<std::uint32_t>(table.sample((i + 0.5) / count).index));
            const Pair p = pair(0, i, 0, 1);
            const float root = std::sqrt(p.a);
            Receiver r;
            r.positions[0] = f.corner + f.edge_u * (root * (1 - p.b)) + f.edge_v * (root * p.b) + f.normal * f.lift;
            r.position_count = 1;
            r.normal = f.normal;
            r.key = i;
            receivers.push_back(r);
        }
    }

    /// Measures closest hits per second, without shading.
    [[nodiscard]] double embree_rate() const {
        const double start = thread_seconds();
        for (const auto& ray : incoherent)
            benchmark::DoNotOptimize(rays.closest(ray.origin, ray.direction, ray.farthest));
        return static_cast<double>(incoherent.size()) / (thread_seconds() - start);
    }
};

const Workplace& cornell() {
    static const Workplace place(cornell_scene({.closed = true}));
    return place;
}

const Workplace& colonnade() {
    static const Workplace place(colonnade_scene());
    return place;
}

const Workplace& million() {
    static const Workplace place([] {
        Scene scene = cornell_scene({.closed = true});
        scene.objects.push_back({"ball", scene.meshes.size(), {}});
        scene.meshes.push_back(wrinkled_ball(707));
        return scene;
    }());
    return place;
}

void closest(benchmark::State& state, const Workplace& place) {
    for (auto _ : state)
        for (const auto& ray : place.incoherent)
            benchmark::DoNotOptimize(place.rays.closest(ray.origin, ray.direction, ray.farthest));
    state.counters["per_item"] =
        benchmark::Counter(static_cast<double>(place.incoherent.size()),
                           benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// Gathers as a bake does: a block of receivers, 64 samples each in passes of 16.
constexpr std::size_t k_block = 64;
void gather_block(const Workplace& place, std::size_t first, GatherBuffer& buffer, PathTracer::Scratch& scratch) {
    for (std::uint32_t pass = 0; pass < 4; ++pass)
        gather(place.tracer, std::span(place.receivers).subspan(first, k_block), {16 * pass, 16}, {}, buffer, scratch);
}

/// Measures one thread; an item is a ray of either kind. `of_embree`: rays per second over Embree's own rate, measured
/// in alternation.
void paths(benchmark::State& state, const Workplace& place) {
    const auto scratch = place.tracer.make_scratch();
    GatherBuffer buffer;
    std::size_t first = 0;
    double seconds = 0, embree = 0, turns = 0;
    for (auto _ : state) {
        state.PauseTiming();
        embree += place.embree_rate();
        ++turns;
        state.ResumeTiming();
        const double start = thread_seconds();
        for (int i = 0; i < 8; ++i, first = (first + k_block) % (place.receivers.size() - k_block))
            gather_block(place, first, buffer, *scratch);
        seconds += thread_seconds() - start;
    }
    const auto rays = static_cast<double>(PathTracer::rays(*scratch));
    state.counters["per_item"] = seconds / rays;
    state.counters["of_embree"] = rays / seconds / (embree / turns);
}

/// Measures all threads: 48,000 receivers, 64 samples, 8 bounces, in passes of 16.
void whole(benchmark::State& state, const Workplace& place) {
    std::atomic<std::uint64_t> rays{0};
    for (auto _ : state)
        tbb::parallel_for(std::size_t{0}, place.receivers.size() / k_block, [&](std::size_t block) {
            const auto scratch = place.tracer.make_scratch();
            GatherBuffer buffer;
            gather_block(place, block * k_block, buffer, *scratch);
            rays += PathTracer::rays(*scratch);
        });
    state.counters["rays"] = benchmark::Counter(static_cast<double>(rays), benchmark::Counter::kIsRate);
}

}  // namespace

void register_trace() {
    using Place = const Workplace& (*)();
    for (const auto& [name, place] :
         {std::pair<std::string, Place>{"cornell", cornell}, {"colonnade", colonnade}, {"million", million}}) {
        benchmark::RegisterBenchmark(("trace.embree_closest." + name).c_str(),
                                     [place = place](benchmark::State& s) { closest(s, place()); });
        benchmark::RegisterBenchmark(("trace." + name + ".1").c_str(),
                                     [place = place](benchmark::State& s) { paths(s, place()); });
    }
    benchmark::RegisterBenchmark("trace.cornell.48000x64", [](benchmark::State& s) { whole(s, cornell()); })
        ->UseRealTime()
        ->MeasureProcessCPUTime()
        ->Unit(benchmark::kMillisecond);
}

}  // namespace lobelia::bench
