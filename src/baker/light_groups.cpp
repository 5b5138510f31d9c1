// The sources of a scene, and their grouping by place.
#include <cassert>
#include <cmath>
#include <numeric>

#include "baker/light.h"

namespace lobelia {
namespace {

/// More suns than this are chosen between by power alone.
constexpr std::size_t k_single_suns = 16;
/// Near sources make at most this many groups.
constexpr std::size_t k_most_near_groups = 32;
/// A group of intensity I and radius r is divided while I r^2 is more than this share of all intensity times the square
/// of the radius around all: then its weight would be far off for who stands near it.
constexpr float k_division = 0.01f;

float brightness(Rgb c) { return std::max(0.0f, luminance(c)); }

}  // namespace

Lights::Lights(const Scene& scene, const Surfaces& surfaces, const PathOptions& options)
    : scene_(&scene), surfaces_(&surfaces), aimed_at_(options.next_event == Switch::on) {
    source_of_emitter_.resize(surfaces.emissive().size());
    add_sky(options);
    add_near();
    // Let emitters and suns find their sources.
    for (std::uint32_t i = 0; i < sources_.size(); ++i) {
        if (sources_[i].kind == Kind::triangle) source_of_emitter_[sources_[i].index] = i;
        if (sources_[i].kind == Kind::sun) suns_[sources_[i].index].source = i;
    }
}

void Lights::add_sky(const PathOptions& options) {
    if (scene_->environment) {
        const Image& image = *scene_->environment;
        const bool lit = std::any_of(image.pixels.begin(), image.pixels.end(), [](Rgb c) { return luminance(c) > 0; });
        if (lit) {
            environment_.emplace(image, options.environment_table == Switch::on
                                            ? EnvironmentLight::Choice::by_brightness
                                            : EnvironmentLight::Choice::uniform);
            const Source source{
                Kind::environment, 0, static_cast<float>(k_pi) * environment_->mean_luminance(), {}, 0, {}, 0};
            add_group({&source, 1}, true);
        }
    }

    std::vector<Source> suns;
    for (const PunctualLight& light : scene_->lights) {
        if (light.kind != PunctualLight::Kind::directional || !(brightness(light.intensity) > 0)) continue;
        Sun sun;
        sun.direction = light.direction * -1.0f;
        sun.irradiance = light.intensity;
        const double radius = options.sun_size == Switch::on ? static_cast<double>(light.angular_radius) : 0;
        const double sine = std::sin(radius), half = std::sin(radius / 2);
        if (radius > 0) {
            sun.flatness = static_cast<float>(2 * half * half);
            sun.radiance = light.intensity * static_cast<float>(1 / (k_pi * sine * sine));
            sun.disc_pdf = static_cast<float>(1 / (4 * k_pi * half * half));
        }
        suns.push_back({Kind::sun,
                        static_cast<std::uint32_t>(suns_.size()),
                        brightness(light.intensity),
                        sun.direction,
                        static_cast<float>(sine),
                        {}});
        suns_.push_back(sun);
    }
    if (suns.size() > k_single_suns) {
        add_group(suns, true);
    } else {
        for (const Source& sun : suns) add_group({&sun, 1}, true);
    }
}

float Lights::mean_emission(std::uint32_t triangle) const {
    // Average over a grid of centroids; never less than a share of the mean factor, so that whatever emits is found.
    constexpr int n = 8;
    double sum = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; i + j < n; ++j) {
            const float u = (static_cast<float>(i) + 1.0f / 3) / n, v = (static_cast<float>(j) + 1.0f / 3) / n;
            sum += static_cast<double>(brightness(surfaces_->emission(triangle, u, v)) *
                                       surfaces_->opacity(triangle, u, v));
        }
    const float most = brightness(scene_->materials[surfaces_->facet(triangle).material].emission);
    return std::max(static_cast<float>(sum / (n * (n + 1) / 2)), 0.02f * most);
}

void Lights::add_near() {
    std::vector<Source> sources;
    for (std::uint32_t e = 0; e < surfaces_->emissive().size(); ++e) {
        const std::uint32_t triangle = surfaces_->emissive()[e];
        const Facet& f = surfaces_->facet(triangle);
        const Vec3 centre = f.corner + (f.edge_u + f.edge_v) * (1.0f / 3);
        const float radius = std::max(
            {length(f.corner - centre), length(f.corner + f.edge_u - centre), length(f.corner + f.edge_v - centre)});
        const float area = 0.5f * length(cross(f.edge_u, f.edge_v));
        sources.push_back({Kind::triangle, e, area * mean_emission(triangle), centre, radius,
                           surfaces_->double_sided(triangle) ? Vec3{} : f.normal, area});
    }
    for (std::uint32_t i = 0; i < scene_->lights.size(); ++i) {
        const PunctualLight& light = scene_->lights[i];
        if (light.kind == PunctualLight::Kind::directional || !(brightness(light.intensity) > 0)) continue;
        sources.push_back({Kind::punctual, i, brightness(light.intensity), light.position, 0, {}, 0});
    }
    if (!sources.empty()) split(std::move(sources));
}

namespace {

/// A sphere around the spheres of all sources, centred between the corners of their box.
template <class Sources>
std::pair<Vec3, float> bounds(const Sources& sources) {
    Vec3 lowest = sources[0].centre, highest = lowest;
    for (const auto& s : sources) {
        lowest = {std::min(lowest.x, s.centre.x), std::min(lowest.y, s.centre.y), std::min(lowest.z, s.centre.z)};
        highest = {std::max(highest.x, s.centre.x), std::max(highest.y, s.centre.y), std::max(highest.z, s.centre.z)};
    }
    const Vec3 centre = (lowest + highest) * 0.5f;
    float radius = 0;
    for (const auto& s : sources) radius = std::max(radius, length(s.centre - centre) + s.radius);
    return {centre, radius};
}

template <class Sources>
float total_strength(const Sources& sources) {
    double sum = 0;
    for (const auto& s : sources) sum += static_cast<double>(s.strength);
    return static_cast<float>(sum);
}

}  // namespace

void Lights::split(std::vector<Source> sources) {
    // Divide the part that would be judged worst, until all are good or there are enough.
    struct Part {
        std::vector<Source> sources;
        float badness;
    };
    const auto make_part = [](std::vector<Source> of) {
        const auto [centre, radius] = bounds(of);
        const float badness = of.size() == 1 ? 0 : total_strength(of) * radius * radius;
        return Part{std::move(of), badness};
    };
    std::vector<Part> parts;
    parts.push_back(make_part(std::move(sources)));
    const float good = k_division * parts[0].badness;
    while (parts.size() < k_most_near_groups) {
        const auto worst = std::max_element(parts.begin(), parts.end(),
                                            [](const Part& a, const Part& b) { return a.badness < b.badness; });
        if (!(worst->badness > good)) break;
        // Halve it at the median along the longest axis.
        std::vector<Source> all = std::move(worst->sources);
        const auto extent = [&](auto axis) {
            const auto [low, high] = std::minmax_element(all.begin(), all.end(), [&](const Source& a, const Source& b) {
                return axis(a.centre) < axis(b.centre);
            });
            return axis(high->centre) - axis(low->centre);
        };
        const auto x = [](Vec3 v) { return v.x; };
        const auto y = [](Vec3 v) { return v.y; };
        const auto z = [](Vec3 v) { return v.z; };
        const float ex = extent(x), ey = extent(y), ez = extent(z);
        const auto halve = [&](auto axis) {
            std::stable_sort(all.begin(), all.end(),
                             [&](const Source& a, const Source& b) { return axis(a.centre) < axis(b.centre); });
        };
        if (ex >= ey && ex >= ez) {
            halve(x);
        } else if (ey >= ez) {
            halve(y);
        } else {
            halve(z);
        }
        const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
        Part second = make_part({middle, all.end()});
        *worst = make_part({all.begin(), middle});
        parts.push_back(std::move(second));
    }
    for (const Part& part : parts) add_group(part.sources, false);
}

void Lights::add_group(std::span<const Source> sources, bool far) {
    assert(groups_.size() < k_most_groups && !sources.empty());
    Group group;
    group.first = static_cast<std::uint32_t>(sources_.size());
    group.count = static_cast<std::uint32_t>(sources.size());
    group.far = far;
    group.strength = total_strength(sources);
    if (!far) {
        std::tie(group.centre, group.radius) = bounds(sources);
    } else if (sources.size() == 1) {
        group.centre = sources[0].centre;
        group.radius = sources[0].radius;
    }
    std::vector<float> strengths;
    for (const Source& s : sources) strengths.push_back(s.strength);
    if (sources.size() > 1) group.table.emplace_back(strengths);
    for (std::size_t i = 0; i < sources.size(); ++i) {
        sources_.push_back(sources[i]);
        sources_.back().group = static_cast<std::uint32_t>(groups_.size());
        sources_.back().share = sources.size() > 1 ? static_cast<float>(group.table[0].probability(i)) : 1.0f;
    }

    // One-sided triangles that all face one way are not seen from behind the hindmost.
    const Vec3 front = sources[0].front;
    const bool parallel =
        std::all_of(sources.begin(), sources.end(), [&](const Source& s) { return dot(s.front, front) > 1 - 1e-6f; });
    group.least = parallel ? std::numeric_limits<float>::max() : std::numeric_limits<float>::lowest();
    if (parallel) {
        group.front = front;
        for (const Source& s : sources) {
            const Facet& f = surfaces_->facet(surfaces_->emissive()[s.index]);
            for (const Vec3 p : {f.corner, f.corner + f.edge_u, f.corner + f.edge_v})
                group.least = std::min(group.least, dot(front, p) - 4 * f.lift);
        }
    }
    groups_.push_back(std::move(group));
}

}  // namespace lobelia
