// The search for lobes: the projected objective and its gradient, starts, the joint norm at the end.
#include "core/basis/sg/lobe_fit.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "core/basis/sg/spherical_gaussians.h"
#include "core/math/harmonics.h"
#include "core/math/harmonics_degree_2.h"
#include "core/math/kernels.h"
#include "core/math/minimise.h"
#include "core/math/small_nnls.h"

namespace lobelia {
namespace {

using gaussian::Lobe;

constexpr std::size_t k_most_lobes = k_most_fitted_lobes, k_variables = 4;
constexpr std::size_t k_cells = k_lobe_fit_resolution * k_lobe_fit_resolution;
static_assert(k_cells % k_block_size == 0);

/// Flatter lobes than the least are constants. The sharpest has the solid angle of a cell: what is smaller than a cell
/// is seen as the cell, wherever in it it lies.
const double k_least_sharpness = 0.02, k_most_sharpness = k_cells / 2.0;

using Nnls = SmallNnls<k_most_lobes>;

/// The cells as samples of no radiance, in the frame of the map.
const Samples& cells() {
    static const Samples once = [] {
        const OctahedralMap map{k_lobe_fit_resolution};
        Samples result(k_cells);
        for (std::size_t i = 0; i < k_cells; ++i) {
            const auto cell = map.cell(i);
            const auto& m = cell.first_moment;
            const Vec3 d{static_cast<float>(m[0]), static_cast<float>(m[1]), static_cast<float>(m[2])};
            result.set(i, {normalize(d), {}, static_cast<float>(cell.solid_angle)});
        }
        return result;
    }();
    return once;
}

/// The projected problem: the best amplitudes for given lobes, what they leave, and how that changes with the lobes.
/// All memory is taken at the start.
class Problem {
  public:
    Problem(std::size_t most, std::span<const Rgb> light)
        : light_(cells()), values_(most * k_cells), residual_(k_cells), weighted_(k_block_size) {
        for (std::size_t i = 0; i < k_cells; ++i) {
            RadianceSample cell = light_[i];
            cell.radiance = light[i];
            light_.set(i, cell);
            for (std::size_t k = 0; k < 3; ++k)
                energy_ += cell.solid_angle * std::pow(static_cast<double>(channel_of(light[i], k)), 2);
        }
        for (auto& free : free_) free.fill(true);
    }

    /// Returns the integral of the squared light.
    [[nodiscard]] double energy() const { return energy_; }
    [[nodiscard]] Rgb amplitude(std::size_t j) const { return amplitudes_[j]; }

    /// Lobes from variables, four for each: an axis of any length, and the logarithm of the sharpness.
    static Lobe lobe_at(std::span<const double> x, std::size_t j) {
        x = x.subspan(k_variables * j, k_variables);
        const Vec3 axis{static_cast<float>(x[0]), static_cast<float>(x[1]), static_cast<float>(x[2])};
        return {normalize(axis), static_cast<float>(std::clamp(std::exp(x[3]), k_least_sharpness, k_most_sharpness))};
    }

    /// The squared error that the lobes leave, over the light's own square; finds amplitudes and residual.
    double solve(std::span<const double> x) {
        const std::size_t n = x.size() / k_variables;
        std::array<float, k_most_lobes*(k_most_lobes + 1) / 2> sums{};
        std::array<float, 3 * k_most_lobes> moments{};
        for_each_part(light_.view(), k_block_size, [&](SampleView block, std::size_t begin) {
            float* rows = values_.data() + begin * n;
            for (std::size_t j = 0; j < n; ++j)
                gaussian_row(lobe_at(x, j), block.directions(), rows + j * k_block_size);
            kernels::add_gram(rows, n, block, sums.data());
            kernels::add_moments(rows, n, block, moments.data());
        });
        const float* next = sums.data();
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = i; j < n; ++j) gram_[i * n + j] = gram_[j * n + i] = *next++;
        // Lobes that come to lie on each other share their light.
        for (std::size_t i = 0; i < n; ++i) gram_[i * n + i] *= 1 + 1e-5;
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t j = 0; j < n; ++j) moments_[k][j] = moments[3 * j + k];
        solve_amplitudes(gram_, moments_, n);
        return leave_residual(n) / energy_;
    }

    /// The same, and the gradient: amplitudes are at their best, so only the lobes' own change counts.
    double operator()(std::span<const double> x, std::span<double> gradient) {
        const double value = solve(x);
        for (std::size_t j = 0; j < x.size() / k_variables; ++j) {
            const Lobe lobe = lobe_at(x, j);
            std::array<float, 3> first{};
            float mean = 0;
            weigh(x.size() / k_variables, j, first, mean);
            const double* const of_lobe = x.data() + k_variables * j;
            const double length = std::hypot(of_lobe[0], of_lobe[1], of_lobe[2]);
            const Vec3 slope{first[0], first[1], first[2]};
            const double along = dot(slope, lobe.axis), scale = 2 / energy_ * lobe.sharpness;
            const Vec3 tangent = slope - lobe.axis * static_cast<float>(along);
            const double sharpness = std::exp(of_lobe[3]);
            const bool free = sharpness > k_least_sharpness && sharpness < k_most_sharpness;
            const double parts[] = {tangent.x / length, tangent.y / length, tangent.z / length,
                                    free ? along - mean : 0};
            for (std::size_t i = 0; i < k_variables; ++i) gradient[k_variables * j + i] = scale * parts[i];
        }
        return value;
    }

    /// Amplitudes again for the lobes of the last solve(), now with the least |fit - L|^2 / |L|^2 + |E_fit - E|^2 /
    /// |E|^2, the joint norm: lobes alone are cut off where the light goes on, and E would lose that.
    void balance(std::span<const double> x) {
        const std::size_t n = x.size() / k_variables;
        const auto light = harmonic_light();
        double irradiance = 0;
        for_each_harmonic([&](std::size_t l, std::size_t i) {
            for (std::size_t k = 0; k < 3; ++k) irradiance += std::pow(harmonics::clamped_cosine(l) * light[k][i], 2);
        });
        if (!(irradiance > 0)) return;

        // Zonal series of each lobe's irradiance against each other's and against that of the light.
        const double w = energy_ / irradiance;
        std::array<double, k_most_lobes* k_most_lobes> gram = gram_;
        std::array<Nnls::Vector, 3> m = moments_;
        for (std::size_t i = 0; i < n; ++i) {
            const auto a = series_of(x, i);
            const Vec3 p = lobe_at(x, i).axis;
            const auto y = harmonics::values(k_degree, p.x, p.y, p.z);
            for_each_harmonic([&](std::size_t l, std::size_t h) {
                for (std::size_t k = 0; k < 3; ++k)
                    m[k][i] += w * a[l] * whole_turn(l) * harmonics::clamped_cosine(l) * y[h] * light[k][h];
            });
            for (std::size_t j = 0; j < n; ++j) {
                const auto b = series_of(x, j);
                const double c = dot(p, lobe_at(x, j).axis);
                for (std::size_t l = 0; l <= k_degree; ++l)
                    gram[i * n + j] += w * a[l] * b[l] * whole_turn(l) *
                                       std::legendre(static_cast<unsigned>(l), std::clamp(c, -1.0, 1.0));
            }
        }
        solve_amplitudes(gram, m, n);
    }

    /// The lobe that a search from the largest residual should start with: of several widths the one that takes most.
    [[nodiscard]] Lobe most_wanted() {
        const SampleView all = light_;
        std::size_t place = 0;
        float most = -1;
        for (std::size_t i = 0; i < k_cells; ++i) {
            const float left = -luminance(colour_at(residual_.view(), i)) * std::sqrt(all.solid_angles()[i]);
            if (left > most) {
                most = left;
                place = i;
            }
        }
        Lobe best{direction_at(all.directions(), place), 1};
        double gain = -1;
        for (const float sharpness : {2.0f, 8.0f, 30.0f, 100.0f, 300.0f}) {
            const Lobe lobe{best.axis, sharpness};
            double taken = 0, size = 0;
            for_each_part(all, k_block_size, [&](SampleView block, std::size_t begin) {
                gaussian_row(lobe, block.directions(), weighted_.data());
                for (std::size_t i = 0; i < block.size; ++i) {
                    const double w = block.solid_angles()[i] * weighted_[i];
                    taken -= w * luminance(colour_at(residual_.view(), begin + i));
                    size += w * weighted_[i];
                }
            });
            if (taken > 0 && taken * taken / size > gain) {
                gain = taken * taken / size;
                best.sharpness = sharpness;
            }
        }
        return best;
    }

  private:
    /// Irradiance is followed up to this degree, beyond which there is little.
    static constexpr std::size_t k_degree = 4;
    template <class Visit>
    static void for_each_harmonic(const Visit& visit) {
        for (std::size_t l = 0; l <= k_degree; ++l)
            for (std::size_t i = l * l; i < (l + 1) * (l + 1); ++i) visit(l, i);
    }
    /// Integral of P_l P_l over the sphere.
    static double whole_turn(std::size_t l) { return 4 * k_pi / static_cast<double>(2 * l + 1); }
    static std::array<double, k_degree + 1> series_of(std::span<const double> x, std::size_t j) {
        auto terms = gaussian::irradiance_series(lobe_at(x, j).sharpness);
        terms.resize(k_degree + 1);
        std::array<double, k_degree + 1> result;
        std::copy(terms.begin(), terms.end(), result.begin());
        return result;
    }
    /// Harmonic coefficients of the light, channel by channel.
    [[nodiscard]] std::array<std::array<double, (k_degree + 1) * (k_degree + 1)>, 3> harmonic_light() const {
        const harmonics::Harmonics set(k_degree);
        std::vector<float> rows(set.size() * k_block_size), sums(3 * set.size());
        for_each_part(light_.view(), k_block_size, [&](SampleView block, std::size_t) {
            set.values(block.directions(), rows.data());
            kernels::add_moments(rows.data(), set.size(), block, sums.data());
        });
        std::array<std::array<double, (k_degree + 1) * (k_degree + 1)>, 3> result;
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t i = 0; i < set.size(); ++i) result[k][i] = sums[3 * i + k];
        return result;
    }

    void solve_amplitudes(std::span<const double> gram, const std::array<Nnls::Vector, 3>& m, std::size_t n) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto found = Nnls::solve(gram.first(n * n), m[k], n, free_[k]);
            for (std::size_t j = 0; j < n; ++j) set_channel(amplitudes_[j], k, found[j]);
        }
    }

    /// residual = fit - light; returns its squared norm.
    double leave_residual(std::size_t n) {
        double sum = 0;
        for_each_part(light_.view(), k_block_size, [&](SampleView block, std::size_t begin) {
            const MutableColourView left = residual_.view().part(begin, block.size);
            kernels::combine(values_.data() + begin * n, n, std::span(amplitudes_).first(n), left);
            for (std::size_t k = 0; k < 3; ++k) {
                float* row = left.channel(k);
                const float* light = block.radiance().channel(k);
                for (std::size_t i = 0; i < block.size; ++i) row[i] -= light[i];
                for (std::size_t i = 0; i < block.size; ++i)
                    sum += block.solid_angles()[i] * static_cast<double>(row[i]) * row[i];
            }
        });
        return sum;
    }

    /// Sums over the cells of lobe j's value times what its amplitudes make of the residual: times the direction, and
    /// alone.
    void weigh(std::size_t n, std::size_t j, std::array<float, 3>& first, float& mean) {
        const Rgb a = amplitudes_[j];
        if (a == Rgb{}) return;
        for_each_part(light_.view(), k_block_size, [&](SampleView block, std::size_t begin) {
            const float* values = values_.data() + begin * n + j * k_block_size;
            const float* r[3];
            for (std::size_t k = 0; k < 3; ++k) r[k] = residual_.view().channel(k) + begin;
            for (std::size_t i = 0; i < block.size; ++i)
                weighted_[i] = values[i] * (a.r * r[0][i] + a.g * r[1][i] + a.b * r[2][i]);
            const auto [of_direction, alone] = kernels::weighted_directions(weighted_.data(), block);
            first[0] += of_direction.x;
            first[1] += of_direction.y;
            first[2] += of_direction.z;
            mean += alone;
        });
    }

    Samples light_;
    std::vector<float> values_;  ///< block by block, lobe by lobe
    Colours residual_;
    std::vector<float> weighted_;
    std::array<double, k_most_lobes * k_most_lobes> gram_{};
    std::array<Nnls::Vector, 3> moments_{};
    std::array<Rgb, k_most_lobes> amplitudes_{};
    std::array<std::array<bool, k_most_lobes>, 3> free_{};
    double energy_ = 0;
};

void set_variables(std::span<double> x, std::size_t j, const Lobe& lobe) {
    const double values[] = {lobe.axis.x, lobe.axis.y, lobe.axis.z, std::log(lobe.sharpness)};
    std::copy(std::begin(values), std::end(values), x.begin() + static_cast<std::ptrdiff_t>(k_variables * j));
}

/// The search: descents from several starts.
class Search {
  public:
    Search(Problem& problem, std::size_t count)
        : problem_(problem), count_(count), x_(k_variables * count), best_(x_) {}

    [[nodiscard]] std::span<const double> run() {
        // One lobe after the other where most light is left, all moved after each.
        problem_.solve({});
        grow(0);
        attempt();
        // The same upon a broad one.
        set_variables(x_, 0, {problem_.most_wanted().axis, 0.5f});
        problem_.solve(variables(1));
        grow(1);
        attempt();
        // Lobes spread over the sphere.
        const auto spread = vogel_sphere(count_);
        for (std::size_t j = 0; j < count_; ++j) set_variables(x_, j, {spread[j].axis, 2});
        attempt();
        return best_;
    }

  private:
    [[nodiscard]] std::span<double> variables(std::size_t count) { return std::span(x_).first(k_variables * count); }
    double descend(std::size_t count, std::size_t most_steps) {
        return minimise([&](std::span<const double> at, std::span<double> slope) { return problem_(at, slope); },
                        variables(count), {.most_steps = most_steps, .least_change = 1e-5});
    }
    void grow(std::size_t from) {
        for (std::size_t j = from; j < count_; ++j) {
            set_variables(x_, j, problem_.most_wanted());
            descend(j + 1, 8);
            problem_.solve(variables(j + 1));
        }
    }
    void attempt() {
        double left = descend(count_, 60);
        // A lobe that has lost all its light starts again where most is left.
        for (int revival = 0; revival < 2; ++revival) {
            problem_.solve(x_);
            std::size_t dead = 0;
            while (dead < count_ && luminance(problem_.amplitude(dead)) > 0) ++dead;
            if (dead == count_) break;
            set_variables(x_, dead, problem_.most_wanted());
            left = descend(count_, 30);
        }
        if (left < least_) {
            least_ = left;
            best_ = x_;
        }
    }

    Problem& problem_;
    std::size_t count_;
    std::vector<double> x_, best_;
    double least_ = std::numeric_limits<double>::infinity();
};

}  // namespace

std::vector<FittedLobe> fit_lobes(std::span<const Rgb> light, std::size_t count) {
    check_equal("cells", light.size(), k_cells);
    check_range("lobes", count, 1, k_most_lobes);
    Problem problem(count, light);
    if (!(problem.energy() > 0)) return {};
    Search search(problem, count);
    const auto x = search.run();
    problem.solve(x);
    problem.balance(x);

    std::vector<FittedLobe> result;
    for (std::size_t j = 0; j < count; ++j) result.push_back({Problem::lobe_at(x, j), problem.amplitude(j)});
    const auto brightness = [](const FittedLobe& l) {
        return luminance(l.amplitude) * gaussian::integral(l.lobe.sharpness);
    };
    std::stable_sort(result.begin(), result.end(),
                     [&](const FittedLobe& a, const FittedLobe& b) { return brightness(a) > brightness(b); });
    return result;
}

}  // namespace lobelia
