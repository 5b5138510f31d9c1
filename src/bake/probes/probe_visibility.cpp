#include "bake/probes/probe_visibility.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/octahedral_map.h"
#include "core/sample/directions.h"
#include "lobelia/sampling.h"

namespace lobelia {
namespace {

constexpr std::size_t k_rays = 1024;
constexpr float k_sharpness = 50, k_share_of_back_faces = 0.2f;

/// For each texel of a map the rays that count for it, and their weights, which add up to 1.
struct TexelWeights {
    std::vector<std::uint32_t> ray;
    std::vector<float> weight;
};
std::vector<TexelWeights> weights_of(const Directions& rays, std::size_t side) {
    std::vector<TexelWeights> texels(side * side);
    for (std::size_t t = 0; t < texels.size(); ++t) {
        const auto centre = [&](std::size_t i) {
            return 2 * (static_cast<double>(i) + 0.5) / static_cast<double>(side) - 1;
        };
        const Vec3 direction = OctahedralMap::direction(centre(t % side), centre(t / side));
        float sum = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const float weight = std::pow(std::max(0.0f, dot(direction, direction_at(rays, i))), k_sharpness);
            if (weight < 1e-4f) continue;
            texels[t].ray.push_back(static_cast<std::uint32_t>(i));
            texels[t].weight.push_back(weight);
            sum += weight;
        }
        for (float& weight : texels[t].weight) weight /= sum;
    }
    return texels;
}

/// Pairs of probes that are neighbours.
std::vector<std::array<std::uint32_t, 2>> edges_of(const ProbeSet& probes) {
    std::vector<std::array<std::uint32_t, 2>> edges;
    if (probes.grid) {
        const auto [nx, ny, nz] = probes.grid->count;
        const std::array<std::uint32_t, 3> step = {1, nx, nx * ny}, count = {nx, ny, nz};
        for (std::uint32_t i = 0; i < probes.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k)
                if (i / step[k] % count[k] + 1 < count[k]) edges.push_back({i, i + step[k]});
        return edges;
    }
    for (const ProbeCell& cell : probes.cells)
        for (std::uint32_t corner = 0; corner < 8; ++corner)
            for (const std::uint32_t axis : {1u, 2u, 4u})
                if ((corner & axis) == 0) edges.push_back({cell.corners[corner], cell.corners[corner | axis]});
    return edges;
}

}  // namespace

void measure_visibility(ProbeSet& probes, const PathTracer& tracer, std::size_t side, float reach, StopFlag stop) {
    const Directions directions = uniform_directions(Domain::sphere, Sequence::hammersley, k_rays, 0);
    const std::vector<TexelWeights> texels = weights_of(directions, side);
    probes.visibility_side = side;
    probes.visibility.assign(probes.size() * side * side, {});
    tbb::parallel_for(std::size_t{0}, probes.size(), [&](std::size_t probe) {
        stop.check();
        std::array<PathTracer::Ray, k_rays> rays;
        std::array<PathTracer::Hit, k_rays> hits;
        for (std::size_t i = 0; i < k_rays; ++i)
            rays[i] = {probes.positions[probe], direction_at(directions, i), std::numeric_limits<float>::infinity()};
        tracer.closest(rays, hits);
        std::array<float, k_rays> distance;
        for (std::size_t i = 0; i < k_rays; ++i) {
            const bool hit = std::isfinite(hits[i].distance);
            distance[i] = hit ? std::min(hits[i].distance, reach) : reach;
            if (hit && hits[i].back_face) distance[i] *= k_share_of_back_faces;
        }
        for (std::size_t t = 0; t < texels.size(); ++t) {
            auto& [mean, square] = probes.visibility[probe * texels.size() + t];
            for (std::size_t j = 0; j < texels[t].ray.size(); ++j) {
                const float d = distance[texels[t].ray[j]];
                mean += texels[t].weight[j] * d;
                square += texels[t].weight[j] * d * d;
            }
        }
    });
}

void dilate_probes(ProbeSet& probes) {
    const auto edges = edges_of(probes);
    const std::size_t n = probes.coefficients_per_probe;
    std::vector<std::uint8_t> known(probes.size());
    for (std::size_t i = 0; i < probes.size(); ++i) known[i] = probes.validity[i] >= 0.5f;
    for (bool more = true; more;) {
        more = false;
        std::vector<Rgb> sum(probes.coefficients.size());
        std::vector<std::uint32_t> count(probes.size());
        for (const auto& [a, b] : edges)
            for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, a}}) {
                if (known[from] == 0 || known[to] != 0) continue;
                ++count[to];
                for (std::size_t i = 0; i < n; ++i)
                    sum[to * n + i] = sum[to * n + i] + probes.coefficients[from * n + i];
            }
        for (std::size_t i = 0; i < probes.size(); ++i) {
            if (count[i] == 0) continue;
            for (std::size_t k = 0; k < n; ++k)
                probes.coefficients[i * n + k] = sum[i * n + k] * (1 / static_cast<float>(count[i]));
            known[i] = 1;
            more = true;
        }
    }
}

}  // namespace lobelia
