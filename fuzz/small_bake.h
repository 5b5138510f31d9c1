// A bake that takes a millisecond: for seeds, and for states that must belong to some bake.
#pragma once

#include "lobelia/bake.h"
#include "small_scenes.h"

namespace lobelia {

/// A white square under a constant sky.
inline Scene small_scene() {
    Scene scene;
    scene.name = "small";
    scene.materials = {test::matte({0.5f, 0.5f, 0.5f})};
    Mesh square;
    test::add_square(square, 0, {0, 0, 0}, {1, 0, 0}, {0, 0, -1}, 1);
    square.lightmap_uv = square.uv[0];
    test::add_object(scene, std::move(square));
    scene.environment = test::constant_sky({1, 1, 1});
    return scene;
}

/// 6 x 6 texels with the states of an encoder.
inline BakeJob small_job() {
    BakeJob job;
    job.scene.path = "small.glb";
    job.bake.codec = "sh1/moments/convolution";
    job.bake.atlas.width = job.bake.atlas.height = 6;
    job.bake.samples = 16;
    job.bake.threads = 1;
    job.textures.storages.emplace();
    job.report.write = Switch::off;
    return job;
}

}  // namespace lobelia
