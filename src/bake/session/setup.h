// A bake before its first ray: the scene laid out on pages, its encoding, and the plan of its work.
#pragma once

#include <memory>

#include "bake/gather/encoding.h"
#include "bake/place/atlas.h"
#include "bake/session/plan.h"

namespace lobelia {

struct BakeSetup {
    const Scene* scene = nullptr;
    BakeOptions options;
    World world;
    Atlas atlas;
    TexelMap map;  ///< of options.only_object, if that is set
    BakeEncoding encoding;
    StateLayout layout{nullptr};
    BakePlan plan;
    std::uint64_t hash = 0;  ///< state_hash
    std::unique_ptr<PathTracer> tracer;

    /// Lays out the atlas and checks that codec, memory and options are compatible. The scene must outlive the setup.
    /// Throws Stopped.
    [[nodiscard]] static Result<std::unique_ptr<const BakeSetup>> make(const Scene& scene, const BakeOptions& options,
                                                                       StopFlag stop = {});
};

/// Returns a hash of all that encoder states depend on: scene, codec, atlas, paths; not the number of samples.
[[nodiscard]] std::uint64_t state_hash(const Scene& scene, const BakeOptions& options);

}  // namespace lobelia
