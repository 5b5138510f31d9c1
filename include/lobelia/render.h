// Path tracing of a scene: its options, and pictures from a camera, path-traced or lit by a bake.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "lobelia/image.h"
#include "lobelia/result.h"
#include "lobelia/scene.h"

namespace lobelia {

struct Bake;

enum class Switch { off, on };

struct PathOptions {
    int bounces = 8;         ///< surfaces between a light source and the receiver (texel, probe, or the surface seen)
    std::uint32_t seed = 1;  ///< random seed of all sequences
    Switch next_event = Switch::on;         ///< shadow rays; off: paths hit light sources by chance (slow)
    Switch environment_table = Switch::on;  ///< sample the environment by its brightness; off: uniformly
    Switch roulette = Switch::on;           ///< Russian roulette for weak paths
    Switch sun_size = Switch::on;           ///< off: directional lights are parallel beams, ignoring their radius
};

/// Lightmap UVs of a scene relative to its bake: those that were baked, or those of the copy in the bake's folder
/// (scene.glb), which are UVs of the pages.
enum class LightmapUv { original, of_copy };

/// The surfaces of a bake that its probes light: none; those without a lightmap; all.
enum class ProbeLight { none, unbaked, all };

struct RenderOptions {
    std::size_t width = 960, height = 600;  ///< at least 1 each, at most 2^32 pixels together
    std::uint32_t samples = 64;             ///< per pixel
    unsigned threads = 0;                   ///< 0: one per processor
    LightmapUv lightmap_uv = LightmapUv::original;
    ProbeLight probes = ProbeLight::none;       ///< of a bake; an error where it has none
    const std::atomic<bool>* stop = nullptr;    ///< ends the rendering early when it becomes true
    std::function<void(double)> progress = {};  ///< receives the fraction done; never called concurrently
};

/// Renders a picture by path tracing: radiance [W/(m^2 sr)], the same bits for any number of threads. Unlit surfaces
/// show their base colour. An error if `stop` was set.
/// Precondition: the scene passes check_scene.
[[nodiscard]] Result<Image> render(const Scene& scene, const Camera& camera, const PathOptions& paths = {},
                                   const RenderOptions& options = {});

/// Renders the scene lit by its bake. Where camera rays hit the front of a surface with a lightmap, the light is that
/// of the pages, interpolated bilinearly: irradiance at the shading normal for the diffuse part, and radiance in a
/// sampled direction of the specular lobe. The background, objects without lightmap UVs and backs of double-sided
/// surfaces are path-traced with the bake's own options, unless `probes` has them lit by the bake's probes, as
/// ProbeVolume reads them. An error if `stop` was set, or if scene and bake hold
/// different objects.
[[nodiscard]] Result<Image> render(const Scene& scene, const Bake& bake, const Camera& camera,
                                   const RenderOptions& options = {});

/// Returns the camera that sees the whole scene from the front and a little above, for scenes without one.
[[nodiscard]] Camera default_camera(const Scene& scene);

}  // namespace lobelia
