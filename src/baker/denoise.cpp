// Denoising in coefficient space: an edge-avoiding a-trous filter (Dammertz et al. 2010) whose tolerance for
// differences is the measured standard error (as in Schied et al. 2017), within charts.
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "baker/finish.h"
#include "baker/nearest.h"

namespace lobelia {
namespace {

/// Half of a texel's neighbours; the other half has it as theirs. Binomial weights beside the centre's 1/4.
struct Tap {
    int x, y;
    float weight;
};
constexpr std::array<Tap, 4> k_taps = {Tap{1, 0, 1.0f / 8}, {-1, 1, 1.0f / 16}, {0, 1, 1.0f / 8}, {1, 1, 1.0f / 16}};
constexpr float k_centre = 1.0f / 4;

/// Independent errors of weighted values add by the squares of their weights. After the first pass neighbours have
/// texels in common: a full kernel leaves about half the variance along each axis, not 3/8. This exponent says so, and
/// leaves a texel alone that has no neighbours.
constexpr float k_exponent_of_first = 2, k_exponent_of_later = 1.7f;

/// Between normals, and between the surface and the line to a neighbour [radians]: one standard deviation.
constexpr float k_bend = 0.15f;
/// Neighbours farther away than this, in texel's widths times the step, are no neighbours: the chart has a gap.
constexpr float k_gap = 3;
/// Noise below this share of the irradiance is let alone.
constexpr float k_quiet = 1e-3f;
/// Where coefficients cancel each other, brightness is still this share of the sum of their sizes.
constexpr float k_least_share = 0.25f;

class PageDenoiser {
  public:
    PageDenoiser(Page& page, const PageLayout& layout, std::span<const Vec3> position, std::span<const Vec3> normal,
                 const DenoiseOptions& options)
        : page_(page), layout_(layout), position_(position), normal_(normal), options_(options) {}

    void run(std::span<const double> integrals, double domain_solid_angle);

  private:
    /// How values of a plane are averaged: ratio skips NaN (no ratio known), variance raises the weights.
    enum class Kind { plain, ratio, variance };

    template <class Visit>
    void for_each_usable(const Visit& visit) const;
    void divide(std::span<const double> integrals, double domain_solid_angle);
    void multiply();
    void find_spacing();
    void smooth_variance();
    void weigh(int step);
    [[nodiscard]] float weight(std::size_t i, std::size_t j, float step) const;
    [[nodiscard]] float geometric_weight(std::size_t i, std::size_t j, float step) const;
    void spread_all(int step);
    template <Kind kind>
    void spread(const std::vector<float>& from, std::vector<float>& to, int step) const;

    [[nodiscard]] bool usable(std::size_t i) const { return is_usable(page_, i, options_.least_validity); }
    /// The texel that tap k reaches from (x, y), if it lies on the page.
    [[nodiscard]] bool reach(std::size_t x, std::size_t y, int dx, int dy) const {
        const auto px = static_cast<std::ptrdiff_t>(x) + dx, py = static_cast<std::ptrdiff_t>(y) + dy;
        return px >= 0 && py >= 0 && px < static_cast<std::ptrdiff_t>(page_.width) &&
               py < static_cast<std::ptrdiff_t>(page_.height);
    }
    [[nodiscard]] std::ptrdiff_t offset(int dx, int dy) const {
        return static_cast<std::ptrdiff_t>(page_.width) * dy + dx;
    }

    Page& page_;
    const PageLayout& layout_;
    std::span<const Vec3> position_, normal_;
    const DenoiseOptions& options_;
    std::array<std::vector<float>, 3> brightness_;           ///< by channel
    std::vector<float> spacing_;                             ///< of neighbours in the world, squared
    std::vector<std::array<float, k_taps.size()>> weights_;  ///< of each texel's taps at this step
    tbb::enumerable_thread_specific<std::vector<float>> work_;
};

template <class Visit>
void PageDenoiser::for_each_usable(const Visit& visit) const {
    tbb::parallel_for(std::size_t{0}, page_.height, [&](std::size_t y) {
        for (std::size_t x = 0; x < page_.width; ++x)
            if (const std::size_t i = y * page_.width + x; usable(i)) visit(i, x, y);
    });
}

void PageDenoiser::run(std::span<const double> integrals, double domain_solid_angle) {
    auto& error = page_.planes[layout_.error()];
    divide(integrals, domain_solid_angle);
    // An error that nobody knows counts as none.
    for_each_usable(
        [&](std::size_t i, std::size_t, std::size_t) { error[i] = std::isfinite(error[i]) ? error[i] * error[i] : 0; });
    find_spacing();
    weights_.resize(page_.size());
    smooth_variance();
    for (int level = 0; level < std::clamp(options_.passes, 1, 6); ++level) {
        weigh(1 << level);
        spread_all(1 << level);
    }
    for_each_usable([&](std::size_t i, std::size_t, std::size_t) { error[i] = std::sqrt(error[i]); });
    multiply();
}

void PageDenoiser::divide(std::span<const double> integrals, double domain_solid_angle) {
    for (auto& plane : brightness_) plane.assign(page_.size(), 0);
    for_each_usable([&](std::size_t i, std::size_t, std::size_t) {
        for (std::size_t k = 0; k < 3; ++k) {
            double mean = 0, size = 0;
            for (std::size_t c = 0; c < layout_.coefficients; ++c) {
                const double part = integrals[c] * page_.planes[layout_.coefficient(c, k)][i] / domain_solid_angle;
                mean += part;
                size += std::abs(part);
            }
            const auto brightness = static_cast<float>(std::max(mean, k_least_share * size));
            brightness_[k][i] = brightness;
            for (std::size_t c = 0; c < layout_.coefficients; ++c) {
                float& value = page_.planes[layout_.coefficient(c, k)][i];
                value = brightness > 0 ? value / brightness : NAN;
            }
        }
    });
}

void PageDenoiser::multiply() {
    for_each_usable([&](std::size_t i, std::size_t, std::size_t) {
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t c = 0; c < layout_.coefficients; ++c) {
                float& value = page_.planes[layout_.coefficient(c, k)][i];
                value = std::isnan(value) ? 0 : value * brightness_[k][i];
            }
    });
}

void PageDenoiser::find_spacing() {
    spacing_.assign(page_.size(), 0);
    for_each_usable([&](std::size_t i, std::size_t x, std::size_t y) {
        for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
            if (!reach(x, y, dx, dy)) continue;
            const std::size_t j = i + static_cast<std::size_t>(offset(dx, dy));
            if (!usable(j) || page_.chart[j] != page_.chart[i]) continue;
            const Vec3 d = position_[j] - position_[i];
            spacing_[i] = std::max(spacing_[i], dot(d, d));
        }
    });
}

/// The error is itself measured, and noisy: averages it over 3 x 3 texels by geometry alone.
void PageDenoiser::smooth_variance() {
    for_each_usable([&](std::size_t i, std::size_t x, std::size_t y) {
        for (std::size_t k = 0; k < k_taps.size(); ++k) {
            const bool on_page = reach(x, y, k_taps[k].x, k_taps[k].y);
            const std::size_t j = on_page ? i + static_cast<std::size_t>(offset(k_taps[k].x, k_taps[k].y)) : i;
            weights_[i][k] = on_page ? k_taps[k].weight * geometric_weight(i, j, 1) : 0;
        }
    });
    auto& error = page_.planes[layout_.error()];
    std::vector<float> smooth(page_.size());
    spread<Kind::plain>(error, smooth, 1);
    error.swap(smooth);
}

float PageDenoiser::geometric_weight(std::size_t i, std::size_t j, float step) const {
    if (!usable(j) || page_.chart[i] != page_.chart[j]) return 0;
    const Vec3 d = position_[j] - position_[i];
    const float squared = dot(d, d);
    if (squared > k_gap * k_gap * step * step * std::max(spacing_[i], spacing_[j])) return 0;
    // The squared angle between the normals, and that of the line to either surface, for small angles.
    const float bend = 2 * std::max(0.0f, 1 - dot(normal_[i], normal_[j]));
    const float above = dot(normal_[i], d), below = dot(normal_[j], d);
    const float rise = squared > 0 ? std::max(above * above, below * below) / squared : 0;
    return std::exp(-(bend + rise) / (2 * k_bend * k_bend));
}

float PageDenoiser::weight(std::size_t i, std::size_t j, float step) const {
    const float geometric = geometric_weight(i, j, step);
    if (geometric == 0) return 0;
    const auto& error = page_.planes[layout_.error()];
    const float luminous[3] = {0.2126f, 0.7152f, 0.0722f};
    float difference = 0, sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto& E = page_.planes[layout_.irradiance(k)];
        difference += luminous[k] * std::abs(E[i] - E[j]);
        sum += luminous[k] * (std::abs(E[i]) + std::abs(E[j]));
    }
    const float variance = options_.strength * options_.strength * (error[i] + error[j]);
    const float quiet = k_quiet * sum / 2;
    if (!(variance > 0)) return 0;
    return geometric * std::exp(-difference * difference / (2 * variance)) * variance / (variance + quiet * quiet);
}

void PageDenoiser::weigh(int step) {
    for_each_usable([&](std::size_t i, std::size_t x, std::size_t y) {
        for (std::size_t k = 0; k < k_taps.size(); ++k) {
            const int dx = k_taps[k].x * step, dy = k_taps[k].y * step;
            weights_[i][k] = reach(x, y, dx, dy)
                                 ? k_taps[k].weight *
                                       weight(i, i + static_cast<std::size_t>(offset(dx, dy)), static_cast<float>(step))
                                 : 0;
        }
    });
}

void PageDenoiser::spread_all(int step) {
    // Coefficients, irradiance, error; then the brightness.
    const std::size_t channels = layout_.channels();
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, channels + 3, 1), [&](const auto& range) {
        std::vector<float>& work = work_.local();
        for (std::size_t c = range.begin(); c != range.end(); ++c) {
            std::vector<float>& plane = c < channels ? page_.planes[c] : brightness_[c - channels];
            work.resize(page_.size());
            if (c == layout_.error())
                spread<Kind::variance>(plane, work, step);
            else if (c < 3 * layout_.coefficients)
                spread<Kind::ratio>(plane, work, step);
            else
                spread<Kind::plain>(plane, work, step);
            plane.swap(work);
        }
    });
}

template <PageDenoiser::Kind kind>
void PageDenoiser::spread(const std::vector<float>& from, std::vector<float>& to, int step) const {
    const float exponent = step == 1 ? k_exponent_of_first : k_exponent_of_later;
    for (std::size_t y = 0; y < page_.height; ++y)
        for (std::size_t x = 0; x < page_.width; ++x) {
            const std::size_t i = y * page_.width + x;
            to[i] = from[i];
            if (!usable(i)) continue;
            float sum = 0, total = 0;
            const auto add = [&](std::size_t j, float weight) {
                if (kind == Kind::ratio && std::isnan(from[j])) return;
                sum += (kind == Kind::variance ? std::pow(weight, exponent) : weight) * from[j];
                total += weight;
            };
            add(i, k_centre);
            for (std::size_t k = 0; k < k_taps.size(); ++k) {
                const int dx = k_taps[k].x * step, dy = k_taps[k].y * step;
                const auto there = static_cast<std::size_t>(offset(dx, dy));
                if (weights_[i][k] > 0) add(i + there, weights_[i][k]);
                if (reach(x, y, -dx, -dy) && weights_[i - there][k] > 0) add(i - there, weights_[i - there][k]);
            }
            if (total > 0) to[i] = sum / (kind == Kind::variance ? std::pow(total, exponent) : total);
        }
}

}  // namespace

void denoise(std::span<Page> pages, const PageLayout& layout, const Guides& guides, std::span<const double> integrals,
             double domain_solid_angle, const DenoiseOptions& options) {
    assert(integrals.size() == layout.coefficients && guides.position.size() == pages.size());
    for (std::size_t p = 0; p < pages.size(); ++p)
        PageDenoiser(pages[p], layout, guides.position[p], guides.normal[p], options)
            .run(integrals, domain_solid_angle);
}

}  // namespace lobelia
