// Fitted lobes: the projected objective and its gradient, where the search starts, reading.
#include "lobelia/bases/fitted_gaussians.h"

#include <algorithm>
#include <charconv>
#include <numeric>

#include "lobelia/bases/degree_2.h"
#include "lobelia/bases/sg_irradiance.h"
#include "lobelia/bases/spherical_gaussians.h"
#include "lobelia/encode/least_squares.h"
#include "lobelia/kernels.h"
#include "lobelia/minimise.h"

namespace lobelia {
namespace {

using gaussian::Lobe;

constexpr std::size_t k_most_lobes = 12;
constexpr std::size_t k_cells = FittedGaussians::k_resolution * FittedGaussians::k_resolution;
static_assert(k_cells == k_block_size, "all cells are one block of the kernels");

/// Sharper lobes than this fall between the texels; flatter ones are constants.
const double k_least_sharpness = 0.05, k_most_sharpness = 400;

/// Four points of each cell, cell by cell, in the frame of the map: a lobe's mean over a cell is that over its points.
struct Points {
    static constexpr std::size_t k_per_cell = 4;
    Samples samples{k_per_cell * k_cells};  ///< radiance: the direction; solid angle: the point's share of its cell
    Samples ones{k_per_cell * k_cells};     ///< the same with radiance 1
    std::array<float, k_cells> solid_angles{};

    Points() {
        const OctahedralMap coarse{FittedGaussians::k_resolution}, fine{2 * FittedGaussians::k_resolution};
        for (std::size_t i = 0; i < k_cells; ++i) {
            const double whole = coarse.cell(i).solid_angle;
            solid_angles[i] = static_cast<float>(whole);
            const std::size_t column = 2 * (i % coarse.resolution), row = 2 * (i / coarse.resolution);
            for (std::size_t p = 0; p < k_per_cell; ++p) {
                const auto cell = fine.cell((row + p / 2) * fine.resolution + column + p % 2);
                const auto& m = cell.first_moment;
                const Vec3 d =
                    normalize({static_cast<float>(m[0]), static_cast<float>(m[1]), static_cast<float>(m[2])});
                const auto share = static_cast<float>(cell.solid_angle / whole);
                samples.set(k_per_cell * i + p, {d, {d.x, d.y, d.z}, share});
                ones.set(k_per_cell * i + p, {d, {1, 1, 1}, share});
            }
        }
    }
};
const Points& points() {
    static const Points once;
    return once;
}

/// The projected problem: the best amplitudes for given lobes, what they leave, and how that changes with the lobes.
/// All memory is taken at the start.
class Problem {
  public:
    Problem(std::size_t count, std::span<const Rgb> light)
        : count_(count),
          cells_(k_cells),
          rows_(count * k_cells),
          values_(count * Points::k_per_cell * k_cells),
          residual_(k_cells),
          weighted_(k_block_size),
          gram_(count * count),
          sums_(count * (count + 1) / 2),
          moments_(3 * count),
          amplitudes_(count) {
        for (std::size_t i = 0; i < k_cells; ++i) {
            const float omega = points().solid_angles[i];
            cells_.set(i, {{}, light[i], omega});
            for (std::size_t k = 0; k < 3; ++k)
                energy_ += omega * std::pow(static_cast<double>(channel_of(light[i], k)), 2);
        }
    }

    [[nodiscard]] double energy() const { return energy_; }
    [[nodiscard]] const std::vector<Rgb>& amplitudes() const { return amplitudes_; }
    [[nodiscard]] std::size_t count() const { return count_; }

    /// Lobes from variables, four for each: an axis of any length, and the logarithm of the sharpness.
    static Lobe lobe_at(std::span<const double> x) {
        const Vec3 axis{static_cast<float>(x[0]), static_cast<float>(x[1]), static_cast<float>(x[2])};
        return {normalize(axis), static_cast<float>(std::clamp(std::exp(x[3]), k_least_sharpness, k_most_sharpness))};
    }

    /// The squared error that the first `count` lobes leave, over the light's own square; amplitudes and residuals.
    double solve(std::span<const double> x, std::size_t count) {
        for (std::size_t j = 0; j < count; ++j) fill(j, lobe_at(x.subspan(4 * j, 4)));
        std::fill(sums_.begin(), sums_.end(), 0.0f);
        std::fill(moments_.begin(), moments_.end(), 0.0f);
        kernels::add_gram(rows_.data(), count, cells_, sums_.data());
        kernels::add_moments(rows_.data(), count, cells_, moments_.data());
        gram_.resize(count * count);
        const float* next = sums_.data();
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t j = i; j < count; ++j) gram_[i * count + j] = gram_[j * count + i] = *next++;
        // Lobes that come to lie on each other share their light.
        for (std::size_t i = 0; i < count; ++i) gram_[i * count + i] *= 1 + 1e-5;
        std::fill(amplitudes_.begin(), amplitudes_.end(), Rgb{});
        for (std::size_t k = 0; k < 3; ++k) {
            std::array<double, k_most_lobes> m{};
            for (std::size_t j = 0; j < count; ++j) m[j] = moments_[3 * j + k];
            const auto found = non_negative_least_squares(gram_, std::span(m).first(count));
            for (std::size_t j = 0; j < count; ++j) set_channel(amplitudes_[j], k, found[j]);
        }
        return leave_residual(count) / energy_;
    }

    /// The same with all lobes, and the gradient: amplitudes are at their best, so only the lobes' own change counts.
    double operator()(std::span<const double> x, std::span<double> gradient) {
        const double value = solve(x, count_);
        for (std::size_t j = 0; j < count_; ++j) {
            const auto of_lobe = x.subspan(4 * j, 4);
            const Lobe lobe = lobe_at(of_lobe);
            float first[3] = {}, mean[3] = {};
            weigh(j, first, mean);
            const double length = std::hypot(of_lobe[0], of_lobe[1], of_lobe[2]);
            const Vec3 slope{first[0], first[1], first[2]};
            const double along = dot(slope, lobe.axis), scale = 2 / energy_ * lobe.sharpness;
            const Vec3 tangent = slope - lobe.axis * static_cast<float>(along);
            gradient[4 * j] = scale * tangent.x / length;
            gradient[4 * j + 1] = scale * tangent.y / length;
            gradient[4 * j + 2] = scale * tangent.z / length;
            const double sharpness = std::exp(of_lobe[3]);
            const bool free = sharpness > k_least_sharpness && sharpness < k_most_sharpness;
            gradient[4 * j + 3] = free ? scale * (along - mean[0]) : 0;
        }
        return value;
    }

    /// The cell where most is left, by luminance.
    [[nodiscard]] std::size_t brightest_residual() const {
        std::size_t best = 0;
        float most = -1;
        for (std::size_t i = 0; i < k_cells; ++i) {
            const float left = -luminance(colour_at(residual_.view(), i)) * std::sqrt(points().solid_angles[i]);
            if (left > most) {
                most = left;
                best = i;
            }
        }
        return best;
    }

  private:
    /// Values of lobe j at the points, and their means over the cells.
    void fill(std::size_t j, const Lobe& lobe) {
        float* values = values_.data() + j * Points::k_per_cell * k_cells;
        const SampleView all = points().samples;
        for_each_part(all.directions(), k_block_size,
                      [&](DirectionView block, std::size_t begin) { gaussian_row(lobe, block, values + begin); });
        const float* shares = all.solid_angles();
        for (std::size_t i = 0; i < k_cells; ++i) {
            float sum = 0;
            for (std::size_t p = 0; p < Points::k_per_cell; ++p)
                sum += shares[Points::k_per_cell * i + p] * values[Points::k_per_cell * i + p];
            rows_[j * k_cells + i] = sum;
        }
    }

    /// residual = fit - light; returns its squared norm.
    double leave_residual(std::size_t count) {
        kernels::combine(rows_.data(), count, std::span(amplitudes_).first(count), residual_);
        double sum = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const float* light = cells_.view().radiance().channel(k);
            for (std::size_t i = 0; i < k_cells; ++i) {
                float& r = residual_.channel(k)[i];
                r -= light[i];
                sum += points().solid_angles[i] * static_cast<double>(r) * r;
            }
        }
        return sum;
    }

    /// Sums over the points of lobe j's value times what its amplitudes make of the residual: times the direction, and
    /// alone.
    void weigh(std::size_t j, float* first, float* mean) {
        const Rgb a = amplitudes_[j];
        if (a == Rgb{}) return;
        const float* values = values_.data() + j * Points::k_per_cell * k_cells;
        constexpr std::size_t cells_at_once = k_block_size / Points::k_per_cell;
        for (std::size_t begin = 0; begin < k_cells; begin += cells_at_once) {
            for (std::size_t i = 0; i < cells_at_once; ++i) {
                const Rgb r = colour_at(residual_.view(), begin + i);
                const float w = points().solid_angles[begin + i] * (a.r * r.r + a.g * r.g + a.b * r.b);
                for (std::size_t p = 0; p < Points::k_per_cell; ++p)
                    weighted_[Points::k_per_cell * i + p] = w * values[Points::k_per_cell * (begin + i) + p];
            }
            const std::size_t at = Points::k_per_cell * begin;
            kernels::add_moments(weighted_.data(), 1, points().samples.view().part(at, k_block_size), first);
            kernels::add_moments(weighted_.data(), 1, points().ones.view().part(at, k_block_size), mean);
        }
    }

    std::size_t count_;
    Samples cells_;
    std::vector<float> rows_;    ///< means over cells, lobe by lobe
    std::vector<float> values_;  ///< at the points, lobe by lobe
    Colours residual_;
    std::vector<float> weighted_;
    Matrix gram_;
    std::vector<float> sums_, moments_;
    std::vector<Rgb> amplitudes_;
    double energy_ = 0;
};

void set_variables(std::span<double> x, std::size_t j, Vec3 axis, double sharpness) {
    x[4 * j] = axis.x;
    x[4 * j + 1] = axis.y;
    x[4 * j + 2] = axis.z;
    x[4 * j + 3] = std::log(sharpness);
}

/// One lobe after the other where most light is left, all of one sharpness.
void start_at_residuals(Problem& problem, double sharpness, std::span<double> x) {
    problem.solve(x, 0);
    for (std::size_t j = 0; j < problem.count(); ++j) {
        const std::size_t cell = problem.brightest_residual();
        set_variables(x, j, direction_at(points().samples.view().directions(), Points::k_per_cell * cell), sharpness);
        problem.solve(x, j + 1);
    }
}

void start_spread(Problem& problem, std::span<double> x) {
    const auto lobes = vogel_sphere(problem.count());
    for (std::size_t j = 0; j < lobes.size(); ++j) set_variables(x, j, lobes[j].axis, 2);
}

/// Irradiance of the lobes by one of the formulae; constants are made for each set of coefficients.
class FittedIrradiance final : public Evaluator {
  public:
    explicit FittedIrradiance(SgIrradiance kind) : kind_(kind) {}
    [[nodiscard]] std::string name() const override { return SgIrradianceWeights(kind_, {}).name(); }
    [[nodiscard]] Accuracy accuracy() const override { return SgIrradianceWeights(kind_, {}).accuracy(); }
    void signed_irradiance(std::span<const Rgb> c, DirectionView normals, MutableColourView out) const override {
        const auto [lobes, amplitudes] = FittedGaussians::lobes(c);
        SgIrradianceWeights(kind_, lobes).signed_irradiance(amplitudes, normals, out);
    }

  private:
    SgIrradiance kind_;
};

}  // namespace

Result<std::shared_ptr<const Basis>> FittedGaussians::from_name(std::string_view name) {
    constexpr std::string_view prefix = "sgfit";
    if (!name.starts_with(prefix)) return std::shared_ptr<const Basis>();
    std::size_t count = 0;
    const auto [end, error] = std::from_chars(name.data() + prefix.size(), name.data() + name.size(), count);
    if (error == std::errc::invalid_argument || end != name.data() + name.size()) return std::shared_ptr<const Basis>();
    if (error != std::errc() || count < 1 || count > k_most_lobes)
        return Error{"basis \"" + std::string(name) + "\": the number of lobes must be 1 to 12"};
    return std::shared_ptr<const Basis>(
        std::make_shared<FittedGaussians>(count, std::make_shared<OctahedralTexels>(k_resolution)));
}

std::vector<Meaning> FittedGaussians::meanings() const {
    std::vector<Meaning> result;
    for (std::size_t j = 0; j < count_; ++j) result.insert(result.end(), {Meaning::light, Meaning::shape});
    return result;
}

FittedGaussians::Lobes FittedGaussians::lobes(std::span<const Rgb> c) {
    Lobes result;
    for (std::size_t j = 0; j + 1 < c.size(); j += 2) {
        const Vec3 v{c[j + 1].r, c[j + 1].g, c[j + 1].b};
        const float sharpness = length(v);
        result.lobes.push_back({sharpness > 0 ? v * (1 / sharpness) : Vec3{0, 0, 1}, sharpness});
        result.amplitudes.push_back(c[j]);
    }
    return result;
}

void FittedGaussians::fit(std::span<const Rgb> accumulated, std::span<Rgb> c) const {
    std::fill(c.begin(), c.end(), Rgb{});
    Problem problem(count_, accumulated);
    if (!(problem.energy() > 0)) return;

    // Search from three starts, keep the best.
    std::vector<double> x(4 * count_), best(x);
    double least = std::numeric_limits<double>::infinity();
    const auto attempt = [&] {
        const double left =
            minimise([&](std::span<const double> at, std::span<double> gradient) { return problem(at, gradient); }, x,
                     {.least_change = 1e-5});
        if (left < least) {
            least = left;
            best = x;
        }
    };
    start_at_residuals(problem, 8, x);
    attempt();
    start_at_residuals(problem, 60, x);
    attempt();
    start_spread(problem, x);
    attempt();

    // Store them in order of their light, turned from the map's frame to that of the domain.
    problem.solve(best, count_);
    std::vector<std::size_t> order(count_);
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto light = [&](std::size_t j) {
        return luminance(problem.amplitudes()[j]) *
               gaussian::integral(Problem::lobe_at(std::span(best).subspan(4 * j, 4)).sharpness);
    };
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return light(a) > light(b); });
    const Rotation& m = texels_->map_from_domain();
    for (std::size_t i = 0; i < count_; ++i) {
        const Lobe lobe = Problem::lobe_at(std::span(best).subspan(4 * order[i], 4));
        const Vec3 axis = m[0] * lobe.axis.x + m[1] * lobe.axis.y + m[2] * lobe.axis.z;
        const Vec3 v = axis * lobe.sharpness;
        c[2 * i] = problem.amplitudes()[order[i]];
        c[2 * i + 1] = {v.x, v.y, v.z};
    }
}

void FittedGaussians::radiance(std::span<const Rgb> c, DirectionView directions, MutableColourView out) const {
    const auto [lobes, amplitudes] = FittedGaussians::lobes(c);
    evaluate(SphericalGaussians("", lobes, Domain::sphere), amplitudes, directions, out);
}

std::string FittedGaussians::description() const {
    return std::to_string(count_) + " spherical Gaussians with fitted axes and sharpness";
}

BasisNotes FittedGaussians::notes() const {
    return {"Fitted spherical Gaussians",
            "L(w) = sum of a_j exp(v_j . w - |v_j|), a_j >= 0, v_j the axis times the sharpness; 6 floats a lobe",
            "radiance of a few sources, however sharp, far below other bases at equal floats; never negative",
            "baking many texels (a search for each); filtering, where neighbours' lobes differ"};
}

std::shared_ptr<const Evaluator> FittedGaussians::evaluator(std::string_view name) const {
    const auto names = evaluator_names();
    if (std::find(names.begin(), names.end(), name) == names.end()) return nullptr;
    return std::make_shared<FittedIrradiance>(*sg_irradiance_from_name(name));
}

Basis::Rotated FittedGaussians::rotated(const Rotation& r, std::span<const Rgb> c) const {
    const Rotation& m = texels_->map_from_domain();
    const Rotation turned{rotate(r, m[0]), rotate(r, m[1]), rotate(r, m[2])};
    std::vector<Rgb> lobes(c.begin(), c.end());
    for (std::size_t j = 1; j < lobes.size(); j += 2) {
        const Vec3 v = rotate(r, {c[j].r, c[j].g, c[j].b});
        lobes[j] = {v.x, v.y, v.z};
    }
    return {std::make_shared<FittedGaussians>(count_, std::make_shared<OctahedralTexels>(k_resolution, turned)),
            std::move(lobes)};
}

}  // namespace lobelia
