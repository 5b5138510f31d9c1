// Pictures from a camera, of the tracer's scene: path-traced, or lit by a bake, with the same camera rays.
#pragma once

#include <optional>
#include <span>

#include "lobelia/bake.h"
#include "lobelia/codec.h"
#include "lobelia/probe_volume.h"
#include "trace/path_tracer.h"

namespace lobelia {

/// Renders by path tracing: the mean over a pixel's samples of PathTracer::trace, emitted and scattered light. The
/// tracer counts the surface that is seen as a bounce: to compare with a bake of B bounces, trace B + 1. Nothing if
/// `stop` was set.
[[nodiscard]] std::optional<Image> render_paths(const PathTracer& tracer, const Camera& camera,
                                                const RenderOptions& options = {});

/// A bake's pages, and what is required to evaluate them.
struct BakedLight {
    std::span<const LightmapPage> pages;
    std::vector<AtlasPlacement> placements;  ///< of each object
    PageChannels channels;
    std::optional<Codec> codec;                ///< absent: pages hold irradiance only
    Frame frame = Frame::world;                ///< of the coefficients
    std::optional<ProbeVolume> volume = {};    ///< for objects that probes light
    std::vector<std::uint8_t> by_probes = {};  ///< of each object: nonzero if they light it; empty: none
};
/// Returns the light of a bake, which must outlive it. An error if its codec is unknown.
[[nodiscard]] Result<BakedLight> light_of(const Bake& bake, LightmapUv uv = LightmapUv::original);

/// Renders the scene lit by its bake: render(scene, bake, ...) describes how.
/// Precondition: one placement for each object of the tracer's scene, on pages that exist.
[[nodiscard]] std::optional<Image> render_bake(const PathTracer& tracer, const BakedLight& light, const Camera& camera,
                                               const RenderOptions& options = {});

[[nodiscard]] Camera default_camera(const World& world);

}  // namespace lobelia
