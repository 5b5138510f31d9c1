#include "bake/render/render_around.h"

#include <tbb/parallel_for.h>

#include <atomic>
#include <mutex>

#include "core/stop.h"
#include "lobelia/sampling.h"
#include "trace/path_tracer.h"

namespace lobelia {

Result<ViewAround> render_around(const Scene& scene, Vec3 position, LatLong size, const PathOptions& paths,
                                 const RenderOptions& options) {
    const World world = make_world(scene);
    // The surface that is seen counts as a bounce.
    PathOptions seen = paths;
    seen.bounces += 1;
    const PathTracer tracer(scene, world, seen);
    const StopFlag stop(options.stop);
    ViewAround view{Image(size.width, size.height), 0};
    std::atomic<std::size_t> backs = 0, done = 0;
    std::mutex reporting;
    auto status = unless_stopped([&]() -> Status {
        tbb::parallel_for(std::size_t{0}, size.height, [&](std::size_t y) {
            const auto scratch = tracer.make_scratch();
            std::vector<PathStart> starts(size.width);
            std::vector<Incident> light(size.width);
            for (std::uint32_t s = 0; s < options.samples; ++s) {
                stop.check();
                // The samples of a texel are a Hammersley set, the same for all.
                const double u = (s + 0.5) / options.samples, v = radical_inverse_2(s);
                for (std::size_t x = 0; x < size.width; ++x)
                    starts[x] = {position,
                                 LatLong::direction((static_cast<double>(x) + u) / static_cast<double>(size.width),
                                                    (static_cast<double>(y) + v) / static_cast<double>(size.height)),
                                 static_cast<std::uint32_t>(y * size.width + x), s};
                tracer.trace(starts, light, *scratch);
                for (std::size_t x = 0; x < size.width; ++x) {
                    Rgb& pixel = view.radiance.pixels[y * size.width + x];
                    pixel = pixel + (light[x].emitted + light[x].scattered) * (1 / static_cast<float>(options.samples));
                    if (light[x].back_face) ++backs;
                }
            }
            ++done;
            if (!options.progress || !reporting.try_lock()) return;
            options.progress(static_cast<double>(done) / static_cast<double>(size.height));
            reporting.unlock();
        });
        return Done{};
    });
    if (!status) return status.error();
    view.back_faces = static_cast<double>(backs) / (static_cast<double>(size.size()) * options.samples);
    return view;
}

}  // namespace lobelia
