// Shards and regions.
#include "bake/session/plan.h"

#include <fmt/format.h>

#include "core/math/hash.h"

namespace lobelia {

std::vector<std::uint32_t> texels_of(const TexelMap& map, std::span<const std::uint32_t> tiles) {
    std::vector<std::uint32_t> result;
    for (const std::uint32_t tile : tiles)
        for (std::uint32_t i = map.first_of_tile[tile]; i < map.first_of_tile[tile + 1]; ++i) result.push_back(i);
    return result;
}

std::uint64_t hash_of_texels(std::span<const std::uint32_t> texels) { return hash_of(texels); }

std::vector<std::uint32_t> tiles_of(const TexelMap& map, const Shard& shard) {
    const auto tiles = static_cast<std::uint32_t>(map.first_of_tile.empty() ? 0 : map.first_of_tile.size() - 1);
    const bool deal = shard.by == Shard::By::tiles;
    std::vector<std::uint32_t> result;
    for (std::uint32_t tile = deal ? shard.index : 0; tile < tiles; tile += deal ? shard.count : 1)
        result.push_back(tile);
    return result;
}

PassRange passes_of(const BakeOptions& options, const Shard& shard) {
    const std::uint64_t each = options.samples_per_pass, passes = (options.samples + each - 1) / each;
    if (shard.by == Shard::By::tiles) return {0, static_cast<std::uint32_t>(passes)};
    return {static_cast<std::uint32_t>(passes * shard.index / shard.count),
            static_cast<std::uint32_t>(passes * (shard.index + 1) / shard.count)};
}

Result<BakePlan> make_plan(const TexelMap& map, const BakeOptions& options, std::size_t bytes_per_texel,
                           std::size_t bytes_always) {
    BakePlan plan;
    const Shard& shard = options.shard;
    const PassRange passes = passes_of(options, shard);
    plan.first_pass = passes.first;
    plan.end_pass = passes.end;
    plan.tiles = tiles_of(map, shard);

    // Fill one region after another with the tiles that fit the remaining memory.
    constexpr std::size_t most_in_tile = k_tile * k_tile;
    if (options.memory < bytes_always + most_in_tile * bytes_per_texel)
        return Error{
            fmt::format("--memory {} MiB is too small: scene and pages need {} MiB, plus {} bytes per texel for at "
                        "least one tile of {} texels",
                        options.memory >> 20, (bytes_always >> 20) + 1, bytes_per_texel, most_in_tile)};
    const std::size_t most = (options.memory - bytes_always) / bytes_per_texel;
    std::size_t inside = 0;
    for (std::uint32_t place = 0; place < plan.tiles.size(); ++place) {
        const std::uint32_t tile = plan.tiles[place];
        const std::size_t size = map.first_of_tile[tile + 1] - map.first_of_tile[tile];
        if (plan.regions.empty() || inside + size > most) {
            plan.regions.push_back({place, place});
            inside = 0;
        }
        inside += size;
        plan.regions.back().end = place + 1;
    }
    // Give a shard without tiles one empty region.
    if (plan.regions.empty()) plan.regions.push_back({});
    return plan;
}

}  // namespace lobelia
