// Merging of shards' checkpoints into the checkpoint of the whole bake.
#pragma once

#include <filesystem>

#include "bake/session/setup.h"

namespace lobelia {

/// Writes the states of the whole bake into the folder `checkpoint` from those in its shards' checkpoint folders. Tiles
/// are copied bit by bit; sums of samples are added in the order given. An error if a shard is missing, given twice,
/// unfinished or of another bake; then nothing is left behind.
[[nodiscard]] Status merge_shards(const BakeSetup& bake, std::span<const std::filesystem::path> shards,
                                  const std::filesystem::path& checkpoint, StopFlag stop = {});

}  // namespace lobelia
