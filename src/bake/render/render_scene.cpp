// The library's calls for pictures.
#include "bake/render/render.h"

#include <fmt/format.h>

#include "bake/write/scene_copy.h"

namespace lobelia {
namespace {

/// Counts the surface that the camera sees as the tracer does.
PathOptions with_seen_surface(PathOptions paths) {
    paths.bounces += 1;
    return paths;
}

Result<Image> finished(std::optional<Image> image) {
    if (!image) return Error{"stopped", Error::Kind::stopped};
    return *std::move(image);
}

/// Has the bake's probes light objects.
Status add_probes(BakedLight& light, const Bake& bake, ProbeLight which) {
    if (which == ProbeLight::none) return Done{};
    if (!bake.probes) return Error{"the bake has no probes: bake it with --probes"};
    auto volume = ProbeVolume::make(*bake.probes);
    if (!volume) return Error{"probes: " + volume.error().message};
    light.volume = *std::move(volume);
    for (const AtlasPlacement& placement : light.placements)
        light.by_probes.push_back(which == ProbeLight::all || !placement.baked ? 1 : 0);
    return Done{};
}

}  // namespace

Result<Image> render(const Scene& scene, const Camera& camera, const PathOptions& paths, const RenderOptions& options) {
    const World world = make_world(scene);
    return finished(render_paths(PathTracer(scene, world, with_seen_surface(paths)), camera, options));
}

Result<Image> render(const Scene& scene, const Bake& bake, const Camera& camera, const RenderOptions& options) {
    if (scene.objects.size() != bake.manifest.objects.size())
        return Error{fmt::format("the bake has {} objects, but the scene has {}", bake.manifest.objects.size(),
                                 scene.objects.size())};
    auto light = light_of(bake, options.lightmap_uv);
    if (!light) return light.error();
    if (Status status = add_probes(*light, bake, options.probes); !status) return status.error();
    const World world = make_world(scene);
    const PathTracer tracer(scene, world, with_seen_surface(bake.manifest.options.paths));
    return finished(render_bake(tracer, *light, camera, options));
}

Camera default_camera(const Scene& scene) { return default_camera(make_world(scene)); }

Result<BakedLight> light_of(const Bake& bake, LightmapUv uv) {
    BakedLight light{bake.pages, {}, bake.channels(), {}, Frame::tangent};
    if (!bake.manifest.options.codec.empty()) {
        auto codec = make_codec(bake.manifest.options.codec);
        if (!codec) return codec.error();
        light.codec = *std::move(codec);
        light.frame = bake.manifest.options.frame;
    }
    for (std::size_t i = 0; i < bake.manifest.objects.size(); ++i)
        light.placements.push_back(uv == LightmapUv::of_copy ? placement_in_copy(bake.manifest, i)
                                                             : bake.manifest.objects[i].placement);
    return light;
}

}  // namespace lobelia
