// Bakes a glTF file into a folder: pages, textures, bake.json.
//
//   bake_scene room.glb out
#include <cstdio>

#include "lobelia/bake.h"

int main(int argc, char** argv) {
    using namespace lobelia;
    if (argc != 3) return std::fputs("usage: bake_scene SCENE FOLDER\n", stderr), 2;

    // Load the scene, with lightmap UVs in TEXCOORD_1.
    SceneSource source;
    source.path = argv[1];
    const auto loaded = load_scene(source);
    if (!loaded) return std::fprintf(stderr, "%s\n", loaded.error().message.c_str()), 2;

    // Bake degree-2 spherical harmonics, 64 samples a texel.
    BakeJob job;
    job.bake.codec = "sh2/least-squares/convolution";
    job.bake.atlas = {.width = 128, .height = 128};
    job.bake.samples = 64;
    BakeSession session;
    session.folder = argv[2];
    session.warn = [](const std::string& text) { std::fprintf(stderr, "warning: %s\n", text.c_str()); };
    const auto baked = bake(loaded->scene, job, session);
    if (!baked) return std::fprintf(stderr, "%s\n", baked.error().message.c_str()), 2;

    // Report.
    const BakeStatistics& s = baked->manifest.statistics;
    std::printf("%zu texels, %zu pages, %.1f million rays in %.1f s: %s\n", s.texels, baked->pages.size(),
                static_cast<double>(s.rays) * 1e-6, s.seconds, argv[2]);
}
