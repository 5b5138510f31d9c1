// Collects the light sources of a scene and groups them.
#include <cmath>

#include "scene/light/light_kind.h"
#include "trace/light/light.h"

namespace lobelia {
namespace {

/// Maximum number of suns with a weight each; more are chosen by power alone.
constexpr std::size_t k_single_suns = 16;

}  // namespace

Lights::Lights(const Scene& scene, const Surfaces& surfaces, const PathOptions& options)
    : scene_(&scene), surfaces_(&surfaces), sample_lights_(options.next_event == Switch::on) {
    add_environment(options);
    add_suns(options);
    add_near();
    // Store the source of each emitter and of each sun.
    source_of_emitter_.resize(surfaces.emissive().size());
    for (std::uint32_t i = 0; i < sources_.size(); ++i) {
        if (sources_[i].kind == Kind::triangle) source_of_emitter_[sources_[i].index] = i;
        if (sources_[i].kind == Kind::sun) suns_[sources_[i].index].source = i;
    }
}

void Lights::add_group(std::span<LightSource> sources) {
    groups_.push_back(make_group(sources, static_cast<std::uint32_t>(sources_.size())));
    weights_.add(groups_.back());
    for (LightSource& source : sources) {
        source.group = static_cast<std::uint32_t>(groups_.size() - 1);
        sources_.push_back(source);
    }
}

void Lights::add_environment(const PathOptions& options) {
    if (!scene_->environment) return;
    const Image& image = *scene_->environment;
    if (std::none_of(image.pixels.begin(), image.pixels.end(), [](Rgb c) { return luminance(c) > 0; })) return;
    environment_.emplace(image, options.environment_table == Switch::on ? EnvironmentLight::Choice::by_brightness
                                                                        : EnvironmentLight::Choice::uniform);
    LightSource source;
    source.kind = Kind::environment;
    source.strength = static_cast<float>(k_pi) * environment_->mean_luminance();
    add_group({&source, 1});
}

void Lights::add_suns(const PathOptions& options) {
    std::vector<LightSource> suns;
    for (const PunctualLight& light : scene_->lights) {
        if (light_kind(light.kind).place != LightPlace::far || !(brightness(light.intensity) > 0)) continue;
        const double radius = options.sun_size == Switch::on ? static_cast<double>(light.angular_radius) : 0;
        const double sine = std::sin(radius), half = std::sin(radius / 2);
        Sun sun{Axes(light.direction * -1.0f), light.intensity};
        if (radius > 0) {
            sun.flatness = static_cast<float>(2 * half * half);
            sun.radiance = light.intensity * static_cast<float>(1 / (k_pi * sine * sine));
            sun.disc_pdf = static_cast<float>(1 / (4 * k_pi * half * half));
        }
        LightSource& source = suns.emplace_back();
        source.kind = Kind::sun;
        source.index = static_cast<std::uint32_t>(suns_.size());
        source.strength = brightness(light.intensity);
        source.centre = sun.axes.z;
        source.radius = static_cast<float>(sine);
        suns_.push_back(sun);
    }
    if (suns.size() > k_single_suns) {
        // Put all suns into one group without a direction, so that no receiver's normal culls it.
        add_group(suns);
    } else {
        for (LightSource& sun : suns) add_group({&sun, 1});
    }
}

float Lights::mean_emission(std::uint32_t triangle) const {
    const Material& material = scene_->materials[surfaces_->facet(triangle).material];
    const float most = brightness(material.emission);
    if (!material.emissive_texture && material.alpha_mode == Material::Alpha::opaque) return most;
    // Average over a grid of centroids; keep at least a fraction of the factor, so that every emitter can be sampled.
    constexpr int n = 8;
    double sum = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; i + j < n; ++j) {
            const float u = (static_cast<float>(i) + 1.0f / 3) / n, v = (static_cast<float>(j) + 1.0f / 3) / n;
            sum += static_cast<double>(brightness(surfaces_->emission(triangle, u, v)) *
                                       surfaces_->opacity(triangle, u, v));
        }
    return std::max(static_cast<float>(sum / (n * (n + 1) / 2)), 0.02f * most);
}

void Lights::add_near() {
    std::vector<LightSource> sources;
    for (std::uint32_t e = 0; e < surfaces_->emissive().size(); ++e) {
        const std::uint32_t triangle = surfaces_->emissive()[e];
        const Facet& f = surfaces_->facet(triangle);
        LightSource& source = sources.emplace_back();
        source.kind = Kind::triangle;
        source.index = e;
        source.area = 0.5f * length(cross(f.edge_u, f.edge_v));
        source.strength = source.area * mean_emission(triangle);
        source.centre = f.corner + (f.edge_u + f.edge_v) * (1.0f / 3);
        for (const Vec3 p : {f.corner, f.corner + f.edge_u, f.corner + f.edge_v})
            source.radius = std::max(source.radius, length(p - source.centre));
        if (surfaces_->double_sided(triangle)) continue;
        // Allow for rounding: lower the offset.
        source.front = f.normal;
        source.least = dot(f.normal, source.centre) - 4 * f.lift;
    }
    for (std::uint32_t i = 0; i < scene_->lights.size(); ++i) {
        const PunctualLight& light = scene_->lights[i];
        if (light_kind(light.kind).place == LightPlace::far || !(brightness(light.intensity) > 0)) continue;
        LightSource& source = sources.emplace_back();
        source.kind = Kind::punctual;
        source.index = i;
        source.strength = brightness(light.intensity);
        source.centre = light.position;
    }
    if (sources.empty()) return;
    for (auto& group : grouped_by_place(std::move(sources))) add_group(group);
}

}  // namespace lobelia
