// Renders tiles of pixels in parallel, with batches of rays within them.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <array>
#include <mutex>

#include "bake/render/render.h"
#include "bake/with_threads.h"
#include "trace/camera_view.h"

namespace lobelia {

/// Side of a tile [pixels], and rays per batch.
inline constexpr std::size_t k_tile_side = 8;
inline constexpr std::size_t k_rays_at_once = 256;

/// The pixels of one tile, and the sums over their samples.
struct RenderTile {
    std::array<std::size_t, k_tile_side * k_tile_side> pixel;
    std::array<std::array<double, 3>, k_tile_side * k_tile_side> sum{};
    std::size_t count = 0;

    RenderTile(std::size_t tile, std::size_t width, std::size_t height) {
        const std::size_t across = (width + k_tile_side - 1) / k_tile_side;
        const std::size_t left = tile % across * k_tile_side, top = tile / across * k_tile_side;
        for (std::size_t y = top; y < std::min(height, top + k_tile_side); ++y)
            for (std::size_t x = left; x < std::min(width, left + k_tile_side); ++x) pixel[count++] = y * width + x;
    }
    void add(std::size_t i, Rgb radiance) {
        sum[i][0] += static_cast<double>(radiance.r);
        sum[i][1] += static_cast<double>(radiance.g);
        sum[i][2] += static_cast<double>(radiance.b);
    }
    void finish(std::uint32_t samples, Image& image) const {
        for (std::size_t i = 0; i < count; ++i) {
            const auto mean = [&](std::size_t k) { return static_cast<float>(sum[i][k] / samples); };
            image.pixels[pixel[i]] = {mean(0), mean(1), mean(2)};
        }
    }
};

/// Calls worker.shade(rays, of_ray, tile) for batches of at most k_rays_at_once rays; of_ray holds the place of each
/// ray's pixel in the tile. `make_worker` makes a worker for each thread.
template <class MakeWorker>
std::optional<Image> render_tiles(const CameraRays& rays, const RenderOptions& options, const MakeWorker& make_worker) {
    Image image(options.width, options.height);
    const std::size_t across = (options.width + k_tile_side - 1) / k_tile_side;
    const std::size_t tiles = across * ((options.height + k_tile_side - 1) / k_tile_side);
    tbb::enumerable_thread_specific<decltype(make_worker())> workers(make_worker);
    const auto stopped = [&] { return options.stop != nullptr && options.stop->load(std::memory_order_relaxed); };
    std::mutex progress_mutex;
    std::size_t done = 0;

    const auto render_tile = [&](std::size_t number) {
        if (stopped()) return;
        RenderTile tile(number, options.width, options.height);
        std::vector<PathStart> batch;
        std::vector<std::uint32_t> of_ray;
        const auto shade = [&] {
            workers.local()->shade(batch, of_ray, tile);
            batch.clear();
            of_ray.clear();
        };
        for (std::uint32_t sample = 0; sample < options.samples; ++sample)
            for (std::size_t i = 0; i < tile.count; ++i) {
                batch.push_back(rays.ray(tile.pixel[i], sample));
                of_ray.push_back(static_cast<std::uint32_t>(i));
                if (batch.size() == k_rays_at_once) shade();
            }
        if (!batch.empty()) shade();
        tile.finish(options.samples, image);
        const std::scoped_lock lock(progress_mutex);
        done += 1;
        if (options.progress) options.progress(static_cast<double>(done) / static_cast<double>(tiles));
    };
    with_threads(options.threads, [&] {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tiles), [&](const tbb::blocked_range<std::size_t>& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) render_tile(i);
        });
    });
    if (stopped()) return std::nullopt;
    return image;
}

/// Handles Kind::paths only: traces these sights and adds their radiance. The caller handles the rest.
class PathShader {
  public:
    explicit PathShader(const PathTracer& tracer) : tracer_(&tracer), scratch_(tracer.make_scratch()) {}
    void add(std::span<const Sight> sights, std::span<const std::uint32_t> of_ray, RenderTile& tile);

  private:
    const PathTracer* tracer_;
    std::unique_ptr<PathTracer::Scratch, void (*)(PathTracer::Scratch*)> scratch_;
    std::vector<PathStart> starts_;
    std::vector<std::uint32_t> of_start_;
    std::vector<Incident> incident_;
};

}  // namespace lobelia
