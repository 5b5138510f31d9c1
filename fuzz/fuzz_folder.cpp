// Writes any bytes as the files of a bake's folder, and does with it what eval, render, advise and --resume do first.
// See CMakeLists.txt for how to run it.
#include "bake/render/render.h"
#include "bake/write/irradiance_files.h"
#include "bake/write/manifest.h"
#include "bundle.h"
#include "check_loaded.h"
#include "lobelia/bake.h"
#include "memory_folder.h"

namespace {

using namespace lobelia;

void check_finite(const Bake& bake) {
    for (const LightmapPage& page : bake.pages)
        for (const auto& plane : page.planes)
            for (const float value : plane) require(std::isfinite(value));
}

/// Renders a tiny picture of what was read.
void draw(const std::filesystem::path& folder, const Bake& bake) {
    const auto loaded = read_baked_scene(folder, bake.manifest);
    if (!check_result(loaded)) return;
    RenderOptions options;
    options.width = options.height = 8;
    options.samples = options.threads = 1;
    options.lightmap_uv = bake.manifest.scene ? LightmapUv::of_copy : LightmapUv::original;
    check_result(render(loaded->scene, bake, default_camera(loaded->scene), options));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const MemoryFolder folder;
    folder.clear();
    unbundle(bytes_of(data, size),
             [&](const char* name, std::span<const std::byte> bytes) { folder.write(name, bytes); });
    check_result(read_job(folder.path()));
    const auto bake = read_bake(folder.path());
    if (!check_result(bake)) return 0;
    check_finite(*bake);
    check_result(write_irradiance(folder.path() / "irradiance", *bake));
    draw(folder.path(), *bake);
    return 0;
}
