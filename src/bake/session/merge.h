// Shards of a bake, put together again.
#pragma once

#include "bake/baker.h"

namespace lobelia {

/// Writes the checkpoint of the whole `bake` (into its options' folder) from those of its shards; Baker::run then
/// resumes it and finds nothing left to do. Tiles are copied, bit by bit; sums of samples are added in the order given.
/// An error where a shard is missing, given twice, unfinished or of another bake.
[[nodiscard]] Status merge_shards(const Baker& bake, std::span<const std::filesystem::path> checkpoints);

}  // namespace lobelia
