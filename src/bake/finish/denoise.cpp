// Denoising in coefficient space: an edge-avoiding a-trous filter (Dammertz et al. 2010) whose tolerance for
// differences is the measured standard error (as in Schied et al. 2017), within charts.
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

#include "bake/finish/atrous.h"
#include "bake/finish/finish.h"
#include "bake/finish/nearest.h"

namespace lobelia {
namespace {

/// Standard deviation [radians] of the angle between normals, and between the surface and the line to a neighbour.
constexpr float k_bend = 0.15f;
/// Maximum distance of neighbours, in texel widths times the step: beyond it the chart has a gap.
constexpr float k_gap = 3;
/// Noise below this fraction of the irradiance is not filtered.
constexpr float k_quiet = 1e-3f;
/// Lower limit of the brightness, as a fraction of the sum of the coefficients' magnitudes: they may cancel.
constexpr float k_least_share = 0.25f;

class PageDenoiser {
  public:
    PageDenoiser(LightmapPage& page, const PageChannels& channels, std::span<const Vec3> position,
                 std::span<const Vec3> normal, const DenoiseOptions& options)
        : page_(page), channels_(channels), position_(position), normal_(normal), options_(options) {}

    void run(std::span<const double> integrals, double domain_solid_angle);

  private:
    template <class Visit>
    void for_each_usable(const Visit& visit) const;
    void divide(std::span<const double> integrals, double domain_solid_angle);
    void multiply();
    void find_spacing();
    void smooth_variance();
    /// Sets the weights of a step: the tap's weight times weight(i, j), for usable texels i and j of one chart.
    template <class Weight>
    void set_weights(std::size_t step, const Weight& weight);
    /// Returns the exponent (at most 0) of the geometric weight; nothing if the texels are not neighbours.
    [[nodiscard]] std::optional<float> geometry(std::size_t i, std::size_t j) const;
    [[nodiscard]] float weight(std::size_t i, std::size_t j) const;
    void average_all();

    [[nodiscard]] bool usable(std::size_t i) const { return is_usable(page_, i, options_.least_validity); }
    LightmapPage& page_;
    const PageChannels& channels_;
    std::span<const Vec3> position_, normal_;
    const DenoiseOptions& options_;
    std::array<std::vector<float>, 3> brightness_;  ///< per channel
    /// Irradiance over brightness, filtered like the coefficients, so that it stays equal to their irradiance at the
    /// normal. The irradiance itself is filtered as well, for the weights.
    std::array<std::vector<float>, 3> irradiance_ratio_;
    std::vector<float> spacing_;  ///< squared distance of neighbours in the world [m^2]
    AtrousWeights weights_;
    tbb::enumerable_thread_specific<std::vector<float>> work_;
};

template <class Visit>
void PageDenoiser::for_each_usable(const Visit& visit) const {
    tbb::parallel_for(std::size_t{0}, page_.height, [&](std::size_t y) {
        options_.stop.check();
        for (std::size_t x = 0; x < page_.width; ++x)
            if (const std::size_t i = y * page_.width + x; usable(i)) visit(i, x, y);
    });
}

void PageDenoiser::run(std::span<const double> integrals, double domain_solid_angle) {
    divide(integrals, domain_solid_angle);
    // Replace unknown errors by 0.
    auto& error = page_.planes[channels_.error()];
    for_each_usable(
        [&](std::size_t i, std::size_t, std::size_t) { error[i] = std::isfinite(error[i]) ? error[i] * error[i] : 0; });
    weights_.width = page_.width;
    weights_.height = page_.height;
    for (auto& plane : weights_.weight) plane.assign(page_.size(), 0);
    find_spacing();
    smooth_variance();
    for (int level = 0; level < std::clamp(options_.passes, 1, 6); ++level) {
        set_weights(std::size_t{1} << level, [&](std::size_t i, std::size_t j) { return weight(i, j); });
        average_all();
    }
    for_each_usable([&](std::size_t i, std::size_t, std::size_t) { error[i] = std::sqrt(error[i]); });
    multiply();
}

void PageDenoiser::divide(std::span<const double> integrals, double domain_solid_angle) {
    for (auto& plane : brightness_) plane.assign(page_.size(), 0);
    for (auto& plane : irradiance_ratio_) plane.assign(page_.size(), NAN);
    for_each_usable([&](std::size_t i, std::size_t, std::size_t) {
        for (std::size_t k = 0; k < 3; ++k) {
            double mean = 0, size = 0;
            for (std::size_t c = 0; c < channels_.coefficients; ++c) {
                const double part = integrals[c] * page_.planes[channels_.coefficient(c, k)][i] / domain_solid_angle;
                mean += part;
                size += std::abs(part);
            }
            const auto brightness = static_cast<float>(std::max(mean, k_least_share * size));
            brightness_[k][i] = brightness;
            if (brightness > 0) irradiance_ratio_[k][i] = page_.planes[channels_.irradiance(k)][i] / brightness;
            for (std::size_t c = 0; c < channels_.coefficients; ++c) {
                float& value = page_.planes[channels_.coefficient(c, k)][i];
                value = brightness > 0 ? value / brightness : NAN;
            }
        }
    });
}

void PageDenoiser::multiply() {
    for_each_usable([&](std::size_t i, std::size_t, std::size_t) {
        for (std::size_t k = 0; k < 3; ++k) {
            for (std::size_t c = 0; c < channels_.coefficients; ++c) {
                float& value = page_.planes[channels_.coefficient(c, k)][i];
                value = std::isnan(value) ? 0 : value * brightness_[k][i];
            }
            const float ratio = irradiance_ratio_[k][i];
            if (!std::isnan(ratio)) page_.planes[channels_.irradiance(k)][i] = ratio * brightness_[k][i];
        }
    });
}

template <class Weight>
void PageDenoiser::set_weights(std::size_t step, const Weight& weight) {
    weights_.step = step;
    for_each_usable([&](std::size_t i, std::size_t x, std::size_t y) {
        for (std::size_t k = 0; k < k_atrous_taps.size(); ++k) {
            const AtrousTap& tap = k_atrous_taps[k];
            const auto there_x = static_cast<std::ptrdiff_t>(x) + tap.x * static_cast<std::ptrdiff_t>(step);
            const std::size_t there_y = y + static_cast<std::size_t>(tap.y) * step;
            float& result = weights_.weight[k][i];
            result = 0;
            if (there_x < 0 || there_x >= static_cast<std::ptrdiff_t>(page_.width) || there_y >= page_.height) continue;
            const std::size_t j = there_y * page_.width + static_cast<std::size_t>(there_x);
            if (usable(j) && page_.chart[i] == page_.chart[j]) result = tap.weight * weight(i, j);
        }
    });
}

void PageDenoiser::find_spacing() {
    spacing_.assign(page_.size(), 0);
    for_each_usable([&](std::size_t i, std::size_t x, std::size_t y) {
        const auto add_neighbour = [&](bool on_page, std::size_t j) {
            if (!on_page || !usable(j) || page_.chart[j] != page_.chart[i]) return;
            const Vec3 d = position_[j] - position_[i];
            spacing_[i] = std::max(spacing_[i], dot(d, d));
        };
        add_neighbour(x > 0, i - 1);
        add_neighbour(x + 1 < page_.width, i + 1);
        add_neighbour(y > 0, i - page_.width);
        add_neighbour(y + 1 < page_.height, i + page_.width);
    });
}

/// Averages the variance over 3 x 3 texels with geometric weights, because the measured variance is noisy.
void PageDenoiser::smooth_variance() {
    set_weights(1, [&](std::size_t i, std::size_t j) {
        const std::optional<float> exponent = geometry(i, j);
        return exponent ? std::exp(*exponent) : 0;
    });
    auto& error = page_.planes[channels_.error()];
    std::vector<float> smooth(page_.size());
    average(weights_, AtrousMean::values, error, smooth);
    error.swap(smooth);
}

std::optional<float> PageDenoiser::geometry(std::size_t i, std::size_t j) const {
    const Vec3 d = position_[j] - position_[i];
    const float squared = dot(d, d), reach = k_gap * static_cast<float>(weights_.step);
    if (squared > reach * reach * std::max(spacing_[i], spacing_[j])) return std::nullopt;
    // Compute squared angles, for small angles: between the normals, and between the line and either surface.
    const float bend = 2 * std::max(0.0f, 1 - dot(normal_[i], normal_[j]));
    const float above = dot(normal_[i], d), below = dot(normal_[j], d);
    const float rise = squared > 0 ? std::max(above * above, below * below) / squared : 0;
    return -(bend + rise) / (2 * k_bend * k_bend);
}

float PageDenoiser::weight(std::size_t i, std::size_t j) const {
    const auto& error = page_.planes[channels_.error()];
    const float variance = options_.strength * options_.strength * (error[i] + error[j]);
    if (!(variance > 0)) return 0;
    const std::optional<float> exponent = geometry(i, j);
    if (!exponent) return 0;
    constexpr float luminous[3] = {0.2126f, 0.7152f, 0.0722f};
    float difference = 0, sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto& E = page_.planes[channels_.irradiance(k)];
        difference += luminous[k] * std::abs(E[i] - E[j]);
        sum += luminous[k] * (std::abs(E[i]) + std::abs(E[j]));
    }
    const float quiet = k_quiet * sum / 2;
    return std::exp(*exponent - difference * difference / (2 * variance)) * variance / (variance + quiet * quiet);
}

void PageDenoiser::average_all() {
    // Filter ratios, irradiance and error; then the brightness, and the ratios of the irradiance.
    const std::size_t channels = channels_.count();
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, channels + 6, 1), [&](const auto& range) {
        std::vector<float>& work = work_.local();
        for (std::size_t c = range.begin(); c != range.end(); ++c) {
            options_.stop.check();
            const bool ratio = c < 3 * channels_.coefficients || c >= channels + 3;
            AtrousMean mean = ratio ? AtrousMean::known_values : AtrousMean::values;
            if (c == channels_.error())
                mean = weights_.step == 1 ? AtrousMean::first_variances : AtrousMean::later_variances;
            std::vector<float>& plane = c < channels       ? page_.planes[c]
                                        : c < channels + 3 ? brightness_[c - channels]
                                                           : irradiance_ratio_[c - channels - 3];
            work.resize(page_.size());
            average(weights_, mean, plane, work);
            plane.swap(work);
        }
    });
}

}  // namespace

void denoise(std::span<LightmapPage> pages, const PageChannels& channels, const Guides& guides,
             std::span<const double> integrals, double domain_solid_angle, const DenoiseOptions& options) {
    assert(integrals.size() == channels.coefficients && guides.position.size() == pages.size());
    for (std::size_t p = 0; p < pages.size(); ++p)
        PageDenoiser(pages[p], channels, guides.position[p], guides.normal[p], options)
            .run(integrals, domain_solid_angle);
}

}  // namespace lobelia
