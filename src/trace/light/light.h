// All light sources of a scene, and the choice of one for a point that wants light.
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

/// One light source as it would reach a point if nothing stood between.
struct LightSample {
    Vec3 direction;      ///< unit, towards the source
    float distance = 0;  ///< within which whatever stands hides it; infinite for the sky
    Rgb irradiance;      ///< L / pdf, or that of a source without size over its probability; black: nothing comes
    float pdf = 0;       ///< of the direction [1/sr]; 0 of a source without size
};

/// Radiance from a direction in which no surface stands, and the density with which `sample` finds it.
struct SkyLight {
    Rgb radiance;
    float pdf = 0;
};

class Lights {
  public:
    /// `scene` and `surfaces` must outlive this.
    Lights(const Scene& scene, const Surfaces& surfaces, const PathOptions& options);

    [[nodiscard]] bool any() const { return !groups_.empty(); }
    /// A source in proportion to what it might bring to the vantage, by its power and roughly its distance; then a
    /// point on it.
    [[nodiscard]] LightSample sample(const Vantage& at, float choice, Pair point) const;
    /// Density [1/sr] with which `sample` finds the point of emissive triangle `emitter` at this distance, whose normal
    /// has this cosine to the ray.
    [[nodiscard]] float triangle_pdf(const Vantage& at, std::uint32_t emitter, float distance, float cosine) const;
    [[nodiscard]] SkyLight sky(const Vantage& at, Vec3 direction) const;

  private:
    using Kind = LightSource::Kind;
    /// A disc in the sky, or a parallel beam.
    struct Sun {
        Axes axes;  ///< z towards it
        Rgb irradiance;
        Rgb radiance;        ///< of the disc
        float flatness = 0;  ///< 1 - cosine of the angular radius; 0: a parallel beam
        float disc_pdf = 0;  ///< uniform over the disc [1/sr]
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
    bool aimed_at_;
    std::optional<EnvironmentLight> environment_;
    std::vector<Sun> suns_;
    std::vector<LightSource> sources_;
    std::vector<std::uint32_t> source_of_emitter_;
    std::vector<LightGroup> groups_;
    LightWeights weights_;
};

}  // namespace lobelia
