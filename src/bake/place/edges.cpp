// Welds vertices by a hashed grid; sorts edges by their welded ends.
#include "bake/place/edges.h"

#include <oneapi/tbb/parallel_sort.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>

#include "core/math/hash.h"

namespace lobelia {
namespace {

constexpr std::uint32_t k_no_vertex = 0xffffffff;

using Cell = std::array<std::int64_t, 3>;

/// Welded vertices by cell: chains in a hash table.
class Grid {
  public:
    /// Makes cells twice as wide as the tolerance, so that all near vertices lie in eight cells.
    Grid(std::size_t vertices, double tolerance)
        : width_(2 * tolerance), first_(std::bit_ceil(2 * vertices + 1), k_no_vertex), next_(vertices, k_no_vertex) {}

    /// Returns the chain of the cell that holds `p` moved by `shift` half cells.
    [[nodiscard]] std::uint32_t& chain(Vec3 p, const Cell& shift) {
        return first_[hash_of(cell(p, shift)) & (first_.size() - 1)];
    }
    [[nodiscard]] std::uint32_t next(std::uint32_t v) const { return next_[v]; }
    void insert(std::uint32_t v, Vec3 p) {
        std::uint32_t& head = chain(p, {0, 0, 0});
        next_[v] = head;
        head = v;
    }

  private:
    [[nodiscard]] Cell cell(Vec3 p, const Cell& shift) const {
        // Beyond 2^52 cells, different positions are farther apart than the tolerance.
        const auto along = [&](float x, std::int64_t s) {
            return static_cast<std::int64_t>(
                std::clamp(std::floor(x / width_ + 0.5 * static_cast<double>(s)), -0x1p52, 0x1p52));
        };
        return {along(p.x, shift[0]), along(p.y, shift[1]), along(p.z, shift[2])};
    }

    double width_;
    std::vector<std::uint32_t> first_, next_;
};

}  // namespace

std::vector<std::uint32_t> weld_positions(const World& world, float tolerance, StopFlag stop) {
    const auto count = static_cast<std::uint32_t>(world.positions.size());
    // Keep the grid's cells above zero width; floats near 1 are not finer than this.
    const float near = std::max(tolerance, 1e-8f);
    Grid grid(count, near);
    std::vector<std::uint32_t> welded(count);
    for (std::uint32_t v = 0; v < count; ++v) {
        stop.check();
        const Vec3 p = world.positions[v];
        // Search the eight cells that a cube of twice the tolerance may touch.
        std::uint32_t found = k_no_vertex;
        for (std::int64_t corner = 0; corner < 8; ++corner) {
            const Cell shift{(corner & 1) * 2 - 1, (corner >> 1 & 1) * 2 - 1, (corner >> 2) * 2 - 1};
            for (std::uint32_t u = grid.chain(p, shift); u != k_no_vertex; u = grid.next(u))
                if (u < found && length(world.positions[u] - p) <= near) found = u;
        }
        welded[v] = found == k_no_vertex ? v : found;
        if (found == k_no_vertex) grid.insert(v, p);
    }
    return welded;
}

std::vector<WorldEdge> sorted_edges(const World& world, const std::vector<std::uint32_t>& welded) {
    std::vector<WorldEdge> edges;
    edges.reserve(3 * world.triangles.size());
    for (std::uint32_t t = 0; t < world.triangles.size(); ++t)
        for (std::uint8_t side = 0; side < 3; ++side) {
            const std::uint32_t a = welded[world.triangles[t][side]], b = welded[world.triangles[t][(side + 1u) % 3]];
            if (a != b) edges.push_back({std::min(a, b), std::max(a, b), t, side});
        }
    tbb::parallel_sort(edges, [](const WorldEdge& a, const WorldEdge& b) {
        return std::tie(a.low, a.high, a.triangle, a.side) < std::tie(b.low, b.high, b.triangle, b.side);
    });
    return edges;
}

}  // namespace lobelia
