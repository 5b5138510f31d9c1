// Charts by union-find (Tarjan 1975) over vertices that share position and UV.
#include "bake/place/charts.h"

#include <bit>
#include <numeric>

#include "core/math/hash.h"

namespace lobelia {
namespace {

/// Disjoint sets with path halving; the smallest member represents each, so that the order of unions does not matter.
class DisjointSets {
  public:
    explicit DisjointSets(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0u); }
    [[nodiscard]] std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void unite(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        if (a < b) parent_[b] = a;
        if (b < a) parent_[a] = b;
    }

  private:
    std::vector<std::uint32_t> parent_;
};

/// Vertices with equal keys are one: object, position, UV. Adding 0 gives -0 and 0 the same bits.
using Key = std::array<std::uint32_t, 6>;
Key key_of(const World& world, std::uint32_t object, std::uint32_t vertex) {
    const Vec3 p = world.positions[vertex];
    const Vec2 uv = world.lightmap_uv[vertex];
    const auto bits = [](float f) { return std::bit_cast<std::uint32_t>(f + 0.0f); };
    return {object, bits(p.x), bits(p.y), bits(p.z), bits(uv.x), bits(uv.y)};
}

/// Finds the first vertex with the same key. Open addressing: a table of at least twice as many entries.
class Welder {
  public:
    explicit Welder(std::size_t vertices) : keys_(vertices), table_(std::bit_ceil(2 * vertices + 2), k_free) {}
    [[nodiscard]] std::uint32_t first_like(std::uint32_t vertex, const Key& key) {
        const std::size_t mask = table_.size() - 1;
        keys_[vertex] = key;
        for (std::size_t i = hash_of(key) & mask;; i = (i + 1) & mask) {
            if (table_[i] == k_free) table_[i] = vertex;
            if (keys_[table_[i]] == key) return table_[i];
        }
    }

  private:
    static constexpr std::uint32_t k_free = 0xffffffff;
    std::vector<Key> keys_;
    std::vector<std::uint32_t> table_;
};

}  // namespace

std::vector<std::uint32_t> find_charts(const World& world, std::uint32_t none, StopFlag stop) {
    // Unite the vertices of each triangle, and vertices with equal keys.
    DisjointSets sets(world.positions.size());
    Welder welder(world.positions.size());
    for (std::size_t t = 0; t < world.triangles.size(); ++t) {
        stop.check();
        if (!world.has_lightmap_uv[world.object[t]]) continue;
        for (const std::uint32_t v : world.triangles[t]) {
            sets.unite(v, welder.first_like(v, key_of(world, world.object[t], v)));
            sets.unite(v, world.triangles[t][0]);
        }
    }

    // Number the sets in the order of their first triangles.
    std::vector<std::uint32_t> number(world.positions.size(), none), charts(world.triangles.size(), none);
    std::uint32_t count = 0;
    for (std::size_t t = 0; t < world.triangles.size(); ++t) {
        if (!world.has_lightmap_uv[world.object[t]]) continue;
        std::uint32_t& chart = number[sets.find(world.triangles[t][0])];
        if (chart == none) chart = count++;
        charts[t] = chart;
    }
    return charts;
}

}  // namespace lobelia
