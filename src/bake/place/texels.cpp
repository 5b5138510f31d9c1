// Start points and normals of texels.
#include "bake/place/texels.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cassert>

#include "bake/place/push_out.h"
#include "bake/place/texel_points.h"

namespace lobelia {
namespace {

/// Start points of samples within a texel: a square grid rotated by atan(1/2), so that no two share a row or a column.
constexpr std::array<PagePoint, k_most_positions> k_pattern = {PagePoint{0.375, 0.125}, PagePoint{0.875, 0.375},
                                                               PagePoint{0.125, 0.625}, PagePoint{0.625, 0.875}};
constexpr std::uint32_t k_no_place = 0xffffffff;

/// The triangle of the texel's chart that contains each point of its pattern.
using Holders = std::array<std::uint32_t, k_most_positions>;

/// Makes the receivers of texels of one tile.
class TileTexels {
  public:
    TileTexels(const Atlas& atlas, const TexelMap& map, const PathTracer& tracer)
        : atlas_(atlas), map_(map), tracer_(tracer) {}

    void make(std::size_t begin, Switch push, std::span<Receiver> out) {
        find_holders(begin, begin + out.size());
        reach_.resize(out.size());
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = receiver(begin + i, holders_[i], reach_[i]);
        if (push == Switch::on) push_out(tracer_, reach_, out);
    }

  private:
    void find_holders(std::size_t begin, std::size_t end);
    [[nodiscard]] Receiver receiver(std::size_t i, const Holders& holders, TexelReach& reach) const;
    void add_position(std::size_t t, PagePoint p, Vec3 owner_normal, Receiver& receiver, TexelReach& reach) const;

    const Atlas& atlas_;
    const TexelMap& map_;
    const PathTracer& tracer_;
    std::array<std::uint32_t, k_tile * k_tile> place_;  ///< index into holders_ of each of the tile's texels
    std::vector<Holders> holders_;
    std::vector<TexelReach> reach_;
};

void TileTexels::find_holders(std::size_t begin, std::size_t end) {
    const std::size_t tile = atlas_.tile_of(map_.texels[begin]);
    const TexelBox box = atlas_.box_of_tile(tile);
    place_.fill(k_no_place);
    holders_.assign(end - begin, {k_no_place, k_no_place, k_no_place, k_no_place});
    for (std::size_t i = begin; i < end; ++i)
        place_[(map_.texels[i].y - box.y0) * k_tile + (map_.texels[i].x - box.x0)] =
            static_cast<std::uint32_t>(i - begin);

    // Store the first triangle of the owner's chart that contains a point.
    const auto& charts = atlas_.chart_of_triangle();
    for (const std::uint32_t t : atlas_.triangles_of_tile(tile)) {
        const PageTriangle triangle(atlas_.texel_triangle(t));
        const TexelBox part = atlas_.box_of(t, triangle, box);
        for (int y = part.y0; y < part.y1; ++y)
            for (int x = part.x0; x < part.x1; ++x) {
                const std::uint32_t place = place_[static_cast<std::size_t>(y - box.y0) * k_tile + (x - box.x0)];
                if (place == k_no_place || charts[map_.triangle[begin + place]] != charts[t]) continue;
                for (std::size_t k = 0; k < k_most_positions; ++k)
                    if (std::uint32_t& holder = holders_[place][k];
                        holder == k_no_place && triangle.contains({x + k_pattern[k].x, y + k_pattern[k].y}))
                        holder = t;
            }
    }
}

void TileTexels::add_position(std::size_t t, PagePoint p, Vec3 owner_normal, Receiver& receiver,
                              TexelReach& reach) const {
    const World& world = atlas_.world();
    const Vec3 on_surface = position_at(world, t, PageTriangle(atlas_.texel_triangle(t)).weights(p));
    const Vec3 face = world.face_normal(t), normal = dot(face, face) > 0 ? face : owner_normal;
    receiver.positions[receiver.position_count] = on_surface + normal * tracer_.lift(on_surface);
    reach.normals[receiver.position_count] = normal;
    ++receiver.position_count;
}

Receiver TileTexels::receiver(std::size_t i, const Holders& holders, TexelReach& reach) const {
    const World& world = atlas_.world();
    const std::uint32_t t = map_.triangle[i];
    const CoveredTexel& at = map_.texels[i];
    Receiver result;
    result.normal = surface_of(atlas_, map_, i).normal;
    result.key = static_cast<std::uint32_t>((at.page * atlas_.height() + at.y) * atlas_.width() + at.x);
    const Vec3 face = world.face_normal(t), owner_normal = dot(face, face) > 0 ? face : result.normal;

    // Start samples at the points of the pattern that the texel's chart covers; if there are none, at the middle of its
    // covered part.
    const int x = static_cast<int>(at.x), y = static_cast<int>(at.y);
    reach.width = texel_width(atlas_, t);
    for (std::size_t k = 0; k < k_most_positions; ++k)
        if (holders[k] != k_no_place)
            add_position(holders[k], {x + k_pattern[k].x, y + k_pattern[k].y}, owner_normal, result, reach);
    if (result.position_count == 0) {
        const PageTriangle triangle(atlas_.texel_triangle(t));
        const PagePoint centre{x + 0.5, y + 0.5};
        add_position(t, triangle.contains(centre) ? centre : triangle.part_in(x, y).centroid(), owner_normal, result,
                     reach);
    }
    return result;
}

}  // namespace

void make_receivers(const Atlas& atlas, const TexelMap& map, std::size_t begin, std::size_t end,
                    const PathTracer& tracer, Switch push_out, std::vector<Receiver>& out) {
    assert(begin <= end && end <= map.texels.size());
    out.resize(end - begin);
    TileTexels tile(atlas, map, tracer);
    for (std::size_t i = begin; i < end;) {
        const auto next = std::upper_bound(map.first_of_tile.begin(), map.first_of_tile.end(), i);
        const std::size_t count = std::min<std::size_t>(*next, end) - i;
        tile.make(i, push_out, std::span(out).subspan(i - begin, count));
        i += count;
    }
}

std::vector<std::vector<std::uint8_t>> displaced_texels(const Atlas& atlas, const TexelMap& map,
                                                        const PathTracer& tracer, StopFlag stop) {
    std::vector<std::vector<std::uint8_t>> displaced(atlas.pages(),
                                                     std::vector<std::uint8_t>(atlas.width() * atlas.height()));
    tbb::parallel_for(std::size_t{1}, map.first_of_tile.size(), [&](std::size_t tile) {
        stop.check();
        std::vector<Receiver> receivers;
        const std::size_t begin = map.first_of_tile[tile - 1];
        make_receivers(atlas, map, begin, map.first_of_tile[tile], tracer, Switch::on, receivers);
        for (std::size_t i = 0; i < receivers.size(); ++i) {
            const CoveredTexel& at = map.texels[begin + i];
            displaced[at.page][at.y * atlas.width() + at.x] = receivers[i].moved || receivers[i].buried;
        }
    });
    return displaced;
}

}  // namespace lobelia
