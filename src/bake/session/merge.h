// Merging of shards' checkpoints into the checkpoint of the whole bake.
#pragma once

#include <filesystem>

#include "bake/session/setup.h"
#include "bake/write/files_together.h"

namespace lobelia {

/// Adds the states of the whole bake to `files`, from those in the folders of its shards. Tiles are copied bit by bit;
/// sums of samples are added in the order of their passes. An error unless the shards together hold each pass of each
/// tile exactly once; it says which are missing or given twice, and by which folder.
[[nodiscard]] Status merge_shards(const BakeSetup& bake, std::span<const std::filesystem::path> shards,
                                  FilesTogether& files);

}  // namespace lobelia
