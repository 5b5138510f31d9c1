// The tiles and passes of a bake: its shard of them, in regions whose states fit the memory one after another.
#pragma once

#include "bake/place/atlas.h"
#include "lobelia/bake_job.h"

namespace lobelia {

struct TileRange {
    std::uint32_t first = 0, end = 0;  ///< indices into TexelMap::first_of_tile
};

/// Returns the texel indices of tiles, tile by tile.
[[nodiscard]] std::vector<std::uint32_t> texels_of(const TexelMap& map, std::span<const std::uint32_t> tiles);

/// Passes [first, end) of a bake.
struct PassRange {
    std::uint32_t first = 0, end = 0;
    friend bool operator==(const PassRange&, const PassRange&) = default;
};

/// Returns the passes that a shard takes of the samples, rounded up to whole passes.
[[nodiscard]] PassRange passes_of(const BakeOptions& options, const Shard& shard);

struct BakePlan {
    std::vector<std::uint32_t> tiles;  ///< of this shard, in order
    std::vector<TileRange> regions;    ///< ranges of places in `tiles`
    std::uint32_t first_pass = 0, end_pass = 0;

    [[nodiscard]] std::uint32_t passes() const { return end_pass - first_pass; }
    /// Returns the texel indices of a region, tile by tile.
    [[nodiscard]] std::vector<std::uint32_t> texels(const TexelMap& map, std::size_t region) const {
        return texels_of(map,
                         std::span(tiles).subspan(regions[region].first, regions[region].end - regions[region].first));
    }
};

/// Returns a hash that identifies a list of texels.
[[nodiscard]] std::uint64_t hash_of_texels(std::span<const std::uint32_t> texels);
/// Returns the tiles of a shard, in order. Tiles are dealt out in turn, so that each shard gets some of every part of
/// the scene.
[[nodiscard]] std::vector<std::uint32_t> tiles_of(const TexelMap& map, const Shard& shard);

/// Plans the bake. An error if not even one tile fits into memory beside the scene and the pages.
[[nodiscard]] Result<BakePlan> make_plan(const TexelMap& map, const BakeOptions& options, std::size_t bytes_per_texel,
                                         std::size_t bytes_always);

}  // namespace lobelia
