// The files of states of a bake's shards, and whether they make a whole.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "bake/session/checkpoint.h"
#include "bake/session/setup.h"

namespace lobelia {

/// A file of states, and what it holds of the bake.
struct ShardFile {
    std::filesystem::path path;
    std::filesystem::path folder;  ///< of the shard
    RegionHeader header;
    std::vector<std::uint32_t> tiles;
};

/// Finds the states in the folders of shards and reads their headers; sorted by their first pass. Errors: no states,
/// those of another bake, or headers that cannot be.
[[nodiscard]] Result<std::vector<ShardFile>> find_shard_files(const BakeSetup& bake,
                                                              std::span<const std::filesystem::path> shards);

/// An error unless each tile has each pass of the bake exactly once.
[[nodiscard]] Status check_whole(const BakeSetup& bake, std::span<const ShardFile> files);

}  // namespace lobelia
