// Probes of a regular grid as textures for GPUs.
#pragma once

#include "bake/write/files_together.h"
#include "lobelia/bake_job.h"
#include "lobelia/lightmap.h"

namespace lobelia {

/// Writes probes.STORAGE.TEXTURE.CONTAINER, 3D textures with a texel for each probe, in the storages of the options
/// that suit the probes' codec (absent: float16); probes.validity.CONTAINER, likewise; and probes.visibility.CONTAINER,
/// a 2D texture of all octahedral maps with a border of one texel around each, so that hardware filters them: the map
/// of probe (x, y, z) begins at texel (side + 2) * (x, y + count.y * z), two halves for mean and mean square. Nothing
/// for probes without a grid, or of one layer alone, and where the options ask for no textures. Storages of blocks or
/// with sub-sampled textures, which would mix layers, are left out.
[[nodiscard]] Status add_probe_textures(FilesTogether& files, const ProbeSet& probes, const TextureOptions& options);

}  // namespace lobelia
