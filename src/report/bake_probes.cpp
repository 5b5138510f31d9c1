// Places of probes, their heights, and the spheres drawn there.
#include "report/bake_probes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace lobelia {
namespace {

constexpr float k_white_reflects = static_cast<float>(1 / k_pi);

/// The place of a probe in the grid, and its distance to the next.
struct Place {
    Vec3 position;
    float spacing = std::numeric_limits<float>::max();
};

std::vector<Place> places_of(const ProbeSet& probes) {
    std::vector<Place> places(probes.size());
    for (std::size_t i = 0; i < places.size(); ++i) places[i].position = probes.positions[i];
    if (probes.grid) {
        const auto& [count, origin, spacing] = *probes.grid;
        for (std::size_t i = 0; i < places.size(); ++i) {
            const std::size_t x = i % count[0], y = i / count[0] % count[1], z = i / count[0] / count[1];
            places[i].position = origin + Vec3{spacing.x * static_cast<float>(x), spacing.y * static_cast<float>(y),
                                               spacing.z * static_cast<float>(z)};
            places[i].spacing = std::min(spacing.x, spacing.z);
        }
    }
    for (const ProbeCell& cell : probes.cells)
        for (std::size_t corner = 0; corner < 8; ++corner) {
            Place& place = places[cell.corners[corner]];
            const auto along = [&](std::size_t axis) { return (corner >> axis & 1) != 0 ? cell.size : 0.0f; };
            place.position = cell.lowest + Vec3{along(0), along(1), along(2)};
            place.spacing = std::min(place.spacing, cell.size);
        }
    return places;
}

/// The distinct heights, from the lowest up.
std::vector<float> heights_of(const std::vector<Place>& places) {
    std::vector<float> heights;
    for (const Place& place : places) heights.push_back(place.position.y);
    std::sort(heights.begin(), heights.end());
    if (heights.empty()) return heights;
    const float near = 1e-4f * std::max(heights.back() - heights.front(), 1e-3f);
    std::vector<float> distinct;
    for (const float y : heights)
        if (distinct.empty() || y > distinct.back() + near) distinct.push_back(y);
    return distinct;
}

/// Draws spheres on plans of one scale.
class Planner {
  public:
    Planner(const ProbeSet& probes, const Codec& codec, std::vector<Place> places, std::size_t most_side)
        : probes_(&probes), codec_(&codec), places_(std::move(places)) {
        Vec2 highest{};
        for (std::size_t i = 0; i < places_.size(); ++i) {
            const Vec2 p{places_[i].position.x, places_[i].position.z};
            lowest_ = i == 0 ? p : Vec2{std::min(lowest_.x, p.x), std::min(lowest_.y, p.y)};
            highest = i == 0 ? p : Vec2{std::max(highest.x, p.x), std::max(highest.y, p.y)};
        }

        // Probes anywhere have about so much room each; a sphere need not be larger than 24 pixels.
        const float extent = std::max({highest.x - lowest_.x, highest.y - lowest_.y, 1e-3f});
        const float fair = extent / std::sqrt(static_cast<float>(places_.size()));
        float least = std::numeric_limits<float>::max();
        for (Place& place : places_) {
            if (place.spacing > 1e30f) place.spacing = fair;
            least = std::min(least, place.spacing);
            margin_ = std::max(margin_, place.spacing / 2);
        }
        scale_ = std::min(static_cast<float>(most_side) / (extent + 2 * margin_), 24 / least);
        const auto side = [&](float length) {
            return std::clamp<std::size_t>(static_cast<std::size_t>(std::ceil((length + 2 * margin_) * scale_)), 1,
                                           most_side);
        };
        width_ = side(highest.x - lowest_.x);
        height_ = side(highest.y - lowest_.y);
    }

    [[nodiscard]] ProbePlan plan(float from, float to) const {
        ProbePlan plan{from, 0, Image(width_, height_), std::vector<std::uint16_t>(width_ * height_)};
        for (std::size_t i = 0; i < places_.size(); ++i) {
            if (places_[i].position.y < from || places_[i].position.y >= to) continue;
            draw(i, plan);
            ++plan.count;
        }
        return plan;
    }

  private:
    void draw(std::size_t probe, ProbePlan& plan) const {
        // Find the sphere's pixels and their normals.
        const Place& place = places_[probe];
        const float x = (place.position.x - lowest_.x + margin_) * scale_,
                    y = (place.position.z - lowest_.y + margin_) * scale_;
        const float radius = std::max(0.44f * place.spacing * scale_, 0.75f);
        std::vector<std::size_t> pixels;
        std::vector<Vec3> normals;
        const auto first = [&](float v) { return static_cast<std::size_t>(std::max(0.0f, std::floor(v - radius))); };
        const auto end = [&](float v, std::size_t most) {
            return std::min(most, static_cast<std::size_t>(std::max(0.0f, std::ceil(v + radius))));
        };
        for (std::size_t row = first(y); row < end(y, height_); ++row)
            for (std::size_t column = first(x); column < end(x, width_); ++column) {
                const float u = (static_cast<float>(column) + 0.5f - x) / radius,
                            v = (static_cast<float>(row) + 0.5f - y) / radius, up = 1 - u * u - v * v;
                if (up < 0) continue;
                pixels.push_back(row * width_ + column);
                normals.push_back({u, std::sqrt(up), v});
            }

        // Evaluate its irradiance there.
        Directions directions(pixels.size());
        Colours irradiance(pixels.size());
        for (std::size_t k = 0; k < pixels.size(); ++k) set_entry(directions.view(), k, normals[k]);
        const std::size_t size = probes_->coefficients_per_probe;
        codec_->irradiance(std::span(probes_->coefficients).subspan(probe * size, size), directions, irradiance);
        const bool valid = probes_->validity[probe] >= 0.5f;
        for (std::size_t k = 0; k < pixels.size(); ++k) {
            plan.image.pixels[pixels[k]] = colour_at(irradiance.view(), k) * k_white_reflects;
            plan.marks[pixels[k]] = valid ? ProbePlan::k_valid : ProbePlan::k_invalid;
        }
    }

    const ProbeSet* probes_;
    const Codec* codec_;
    std::vector<Place> places_;
    Vec2 lowest_{};
    float margin_ = 0, scale_ = 1;  ///< [m], pixels per metre
    std::size_t width_ = 1, height_ = 1;
};

}  // namespace

ProbeView view_probes(const ProbeSet& probes, const Codec& codec, const ProbeViewOptions& options) {
    assert(codec.basis().size() == probes.coefficients_per_probe && options.most_plans > 1);
    ProbeView view;
    view.codec = probes.codec;
    view.count = probes.size();
    for (const float validity : probes.validity) view.invalid += validity < 0.5f;
    std::vector<Place> places = places_of(probes);
    const std::vector<float> heights = heights_of(places);
    view.heights = heights.size();
    if (heights.empty()) return view;
    const Planner planner(probes, codec, std::move(places), options.most_side);
    const std::size_t plans = std::min(heights.size(), options.most_plans);
    for (std::size_t k = 0; k < plans; ++k) {
        const std::size_t i = plans == 1 ? 0 : k * (heights.size() - 1) / (plans - 1);
        const float to = i + 1 < heights.size() ? heights[i + 1] : std::numeric_limits<float>::infinity();
        view.plans.push_back(planner.plan(heights[i], to));
    }
    return view;
}

}  // namespace lobelia
