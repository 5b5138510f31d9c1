// Conservative rasterisation of triangles into texels, tile by tile.
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>

#include "bake/place/atlas.h"

namespace lobelia {
namespace {

constexpr std::uint32_t k_no_triangle = 0xffffffff;

/// The triangle that owns each texel of one tile.
struct TileOwners {
    std::array<std::uint32_t, k_tile * k_tile> owner;
    std::array<float, k_tile * k_tile> cover;
};

std::size_t index_in(const TexelBox& tile, int x, int y) {
    return static_cast<std::size_t>(y - tile.y0) * k_tile + static_cast<std::size_t>(x - tile.x0);
}

/// Assigns texels to triangles that contain their centres; the first of several. Returns whether any texel has no
/// owner.
bool own_by_centre(const Atlas& atlas, std::size_t tile, TileOwners& out) {
    const TexelBox box = atlas.box_of_tile(tile);
    std::size_t left = static_cast<std::size_t>(box.x1 - box.x0) * static_cast<std::size_t>(box.y1 - box.y0);
    for (const std::uint32_t t : atlas.triangles_of_tile(tile)) {
        const PageTriangle triangle(atlas.texel_triangle(t));
        const TexelBox part = atlas.box_of(t, triangle, box);
        for (int y = part.y0; y < part.y1; ++y)
            for (int x = part.x0; x < part.x1; ++x) {
                std::uint32_t& owner = out.owner[index_in(box, x, y)];
                if (owner != k_no_triangle || !triangle.contains({x + 0.5, y + 0.5})) continue;
                owner = t;
                if (--left == 0) return false;
            }
    }
    return true;
}

/// Assigns the remaining texels to the triangles that cover most of them.
void own_by_cover(const Atlas& atlas, std::size_t tile, TileOwners& out) {
    const TexelBox box = atlas.box_of_tile(tile);
    for (const std::uint32_t t : atlas.triangles_of_tile(tile)) {
        const PageTriangle triangle(atlas.texel_triangle(t));
        const TexelBox part = atlas.box_of(t, triangle, box);
        for (int y = part.y0; y < part.y1; ++y)
            for (int x = part.x0; x < part.x1; ++x) {
                const std::size_t i = index_in(box, x, y);
                const bool by_centre = out.owner[i] != k_no_triangle && out.cover[i] == 0;
                if (by_centre || !triangle.may_touch({x, y, x + 1, y + 1})) continue;
                const auto cover = static_cast<float>(triangle.part_in(x, y).area());
                if (cover < static_cast<float>(k_least_cover) || cover <= out.cover[i]) continue;
                out.owner[i] = t;
                out.cover[i] = cover;
            }
    }
}

/// Calls visit(x, y, owner) for each owned texel of the tile, in order.
template <class Visit>
void for_each_owned(const Atlas& atlas, std::size_t tile, const Visit& visit) {
    if (atlas.triangles_of_tile(tile).empty()) return;
    TileOwners owners;
    owners.owner.fill(k_no_triangle);
    owners.cover.fill(0);
    if (own_by_centre(atlas, tile, owners)) own_by_cover(atlas, tile, owners);
    const TexelBox box = atlas.box_of_tile(tile);
    for (int y = box.y0; y < box.y1; ++y)
        for (int x = box.x0; x < box.x1; ++x)
            if (const std::uint32_t owner = owners.owner[index_in(box, x, y)]; owner != k_no_triangle)
                visit(x, y, owner);
}

}  // namespace

TexelMap map_texels(const Atlas& atlas, StopFlag stop) {
    // Process tiles in groups, each with its own list, and join the lists in order.
    constexpr std::size_t k_group = 16;
    const std::size_t groups = (atlas.tiles() + k_group - 1) / k_group;
    std::vector<TexelMap> parts(groups);
    tbb::parallel_for(std::size_t{0}, groups, [&](std::size_t g) {
        TexelMap& part = parts[g];
        for (std::size_t tile = g * k_group; tile < std::min((g + 1) * k_group, atlas.tiles()); ++tile) {
            stop.check();
            const auto begin = static_cast<std::uint32_t>(part.texels.size());
            for_each_owned(atlas, tile, [&](int x, int y, std::uint32_t owner) {
                part.texels.push_back(
                    {atlas.page_of_tile(tile), static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)});
                part.triangle.push_back(owner);
            });
            if (part.texels.size() > begin) part.first_of_tile.push_back(begin);
        }
    });

    // Join the lists, and free each once it is copied.
    TexelMap map;
    std::size_t texels = 0;
    for (const TexelMap& part : parts) texels += part.texels.size();
    map.texels.reserve(texels);
    map.triangle.reserve(texels);
    for (TexelMap& part : parts) {
        const auto base = static_cast<std::uint32_t>(map.texels.size());
        for (const std::uint32_t first : part.first_of_tile) map.first_of_tile.push_back(base + first);
        map.texels.insert(map.texels.end(), part.texels.begin(), part.texels.end());
        map.triangle.insert(map.triangle.end(), part.triangle.begin(), part.triangle.end());
        part = {};
    }
    map.first_of_tile.push_back(static_cast<std::uint32_t>(texels));
    return map;
}

}  // namespace lobelia
