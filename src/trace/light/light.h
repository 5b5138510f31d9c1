// All light sources of a scene, and the sampling of one for a shading point.
// Shirley, Wang and Zimmerman 1996 (choosing lights); Veach 1997.
#pragma once

#include <optional>
#include <span>

#include "core/sample/directions.h"
#include "trace/light/environment_light.h"
#include "trace/light/light_source.h"
#include "trace/light/light_weights.h"
#include "trace/path_tracer.h"
#include "trace/surface.h"

namespace lobelia {

/// A sampled light source, before the shadow test.
struct LightSample {
    Vec3 direction;      ///< unit, towards the source
    float distance = 0;  ///< length of the shadow ray; infinite for the sky
    Rgb irradiance;  ///< L / pdf, or of a source without size: irradiance / probability; black if nothing can arrive
    float pdf = 0;   ///< density of the direction [1/sr]; 0 for a source without size
};

/// Radiance of a ray that hits no surface, and the density with which `sample` generates its direction.
struct SkyLight {
    Rgb radiance;
    float pdf = 0;
};

class Lights {
  public:
    /// `scene` and `surfaces` must outlive this.
    Lights(const Scene& scene, const Surfaces& surfaces, const PathOptions& options);

    [[nodiscard]] bool any() const { return !groups_.empty(); }
    /// Samples a source in proportion to its estimated irradiance at the shading point (power and, roughly, distance),
    /// then a point on it.
    [[nodiscard]] LightSample sample(const Vantage& at, float choice, Pair point) const;
    /// Returns the density [1/sr] with which `sample` generates a point of emissive triangle `emitter`, at this
    /// distance and with this cosine between its normal and the ray.
    [[nodiscard]] float triangle_pdf(const Vantage& at, std::uint32_t emitter, float distance, float cosine) const;
    [[nodiscard]] SkyLight sky(const Vantage& at, Vec3 direction) const;

  private:
    using Kind = LightSource::Kind;
    /// A directional light: a disc in the sky, or a parallel beam.
    struct Sun {
        Axes axes;  ///< z points towards the sun
        Rgb irradiance;
        Rgb radiance;        ///< radiance of the disc
        float flatness = 0;  ///< 1 - cosine of the angular radius; 0: a parallel beam
        float disc_pdf = 0;  ///< density of uniform sampling over the disc [1/sr]
        std::uint32_t source = 0;
        Sun(const Axes& a, Rgb e) : axes(a), irradiance(e) {}
    };

    void add_environment(const PathOptions& options);
    void add_suns(const PathOptions& options);
    void add_near();
    void add_group(std::span<LightSource> sources);
    [[nodiscard]] float mean_emission(std::uint32_t triangle) const;

    [[nodiscard]] SkyLight sky(const GroupWeights& weights, float total, const EnvironmentSample& environment) const;
    [[nodiscard]] LightSample sample_sky(const LightSource& source, const GroupWeights& weights, float total,
                                         const Vantage& at, Pair point) const;
    [[nodiscard]] LightSample sample_triangle(const LightSource& source, float probability, const Vantage& at,
                                              Pair point) const;
    [[nodiscard]] LightSample sample_punctual(const PunctualLight& light, float probability, const Vantage& at) const;

    const Scene* scene_;
    const Surfaces* surfaces_;
    bool sample_lights_;
    std::optional<EnvironmentLight> environment_;
    std::vector<Sun> suns_;
    std::vector<LightSource> sources_;
    std::vector<std::uint32_t> source_of_emitter_;
    std::vector<LightGroup> groups_;
    LightWeights weights_;
};

}  // namespace lobelia
