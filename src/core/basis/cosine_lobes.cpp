// Cosine lobes: values, inner products by one-dimensional quadrature, irradiance in closed form.
#include "core/basis/cosine_lobes.h"

#include <algorithm>
#include <span>

#include "core/basis/cosine_lobes_shader.h"
#include "core/basis/icosahedron.h"
#include "core/math/kernels.h"
#include "core/math/quadrature.h"
#include "core/math/scratch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/basis/cosine_lobes.cpp"
#include <hwy/foreach_target.h>  // NOLINT: must precede highway.h
#include <hwy/highway.h>
// NOLINTNEXTLINE: after highway.h
#include "core/math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lobelia::HWY_NAMESPACE {

/// row = k0 + k1 c + ... + k4 c^4, c = max(low, w . axis).
void PolynomialRow(const Vec3& axis, const float* k, float low, DirectionView block, float* row) {
    const D d;
    const V least = hn::Set(d, low);
    for (std::size_t j = 0; j < block.size; j += hn::Lanes(d)) {
        const V c = hn::Max(dot(d, axis, load(d, block, j)), least);
        V sum = hn::Set(d, k[4]);
        for (std::size_t i = 4; i-- > 0;) sum = hn::MulAdd(sum, c, hn::Set(d, k[i]));
        hn::StoreU(sum, d, row + j);
    }
}

/// Divides `count` rows by their sum.
void NormaliseRows(float* rows, std::size_t count, std::size_t size) {
    const D d;
    for (std::size_t j = 0; j < size; j += hn::Lanes(d)) {
        V sum = hn::Zero(d);
        for (std::size_t i = 0; i < count; ++i) sum = hn::Add(sum, hn::LoadU(d, rows + i * k_block_size + j));
        const V factor = hn::Div(hn::Set(d, 1.0f), hn::Max(sum, hn::Set(d, 1e-6f)));
        for (std::size_t i = 0; i < count; ++i) {
            float* row = rows + i * k_block_size + j;
            hn::StoreU(hn::Mul(hn::LoadU(d, row), factor), d, row);
        }
    }
}

}  // namespace lobelia::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobelia {

HWY_EXPORT(PolynomialRow);
HWY_EXPORT(NormaliseRows);

namespace {

using Coefficients = std::array<float, 5>;

/// Antiderivative of (1 - u^2)^k.
double integral_of_sine_power(int k, double u) {
    double sum = 0, binomial = 1, power = u;
    for (int j = 0; j <= k; ++j) {
        sum += binomial * power / (2 * j + 1);
        binomial *= -static_cast<double>(k - j) / (j + 1);
        power *= u * u;
    }
    return sum;
}

/// Integral of (1 - u^2)^k over those heights u = w . e3 at which w = (.., .., u) is above the horizon, A and B the
/// parts of the horizon's normal along the azimuth and along e3.
double above_horizon(int k, double a, double b) {
    const double whole = 2 * integral_of_sine_power(k, 1);
    if (std::abs(b) < 1e-9) return a > 0 ? whole : 0;
    const double upper_part = integral_of_sine_power(k, 1) - integral_of_sine_power(k, -a / std::hypot(a, b));
    return b > 0 ? upper_part
                 : whole - (integral_of_sine_power(k, 1) - integral_of_sine_power(k, a / std::hypot(a, b)));
}

/// A unit vector across both, where they are parallel any across the first.
Vec3 across(Vec3 p, Vec3 q) {
    for (const Vec3 other : {q, Vec3{0, 0, 1}, Vec3{1, 0, 0}}) {
        const Vec3 v = cross(p, other);
        if (length(v) > 1e-4f) return normalize(v);
    }
    return {0, 1, 0};
}

Coefficients scaled(const std::array<double, 5>& square, const std::array<double, 5>& fourth, CosineLobe lobe,
                    double factor) {
    Coefficients k;
    for (std::size_t i = 0; i < 5; ++i)
        k[i] = static_cast<float>(factor * (lobe.square * square[i] + lobe.fourth * fourth[i]));
    return k;
}
Coefficients irradiance_polynomial(CosineLobe lobe) {
    return scaled(k_square_irradiance, k_fourth_irradiance, lobe, k_pi);
}

void fill_rows(const std::vector<Vec3>& axes, const Coefficients& k, float low, DirectionView block, float* rows) {
    for (std::size_t i = 0; i < axes.size(); ++i)
        HWY_DYNAMIC_DISPATCH(PolynomialRow)(axes[i], k.data(), low, block, rows + i * k_block_size);
}

/// Exact irradiance of whole lobes.
class ExactCosineLobes final : public LinearEvaluator {
  public:
    ExactCosineLobes(CosineLobe lobe, std::vector<Vec3> axes)
        : lobe_(lobe), polynomial_(irradiance_polynomial(lobe)), axes_(std::move(axes)) {}
    [[nodiscard]] std::string name() const override { return "exact"; }
    [[nodiscard]] Accuracy accuracy() const override {
        return {"everywhere", "1e-6 of the largest E (float32 rounding)"};
    }
    [[nodiscard]] std::size_t size() const override { return axes_.size(); }
    void values(DirectionView block, float* rows) const override { fill_rows(axes_, polynomial_, -2, block, rows); }
    [[nodiscard]] Result<ShaderCode> irradiance_code() const override { return cosine_lobes::exact_code(lobe_, axes_); }

  private:
    CosineLobe lobe_;
    Coefficients polynomial_;
    std::vector<Vec3> axes_;
};

/// Squared cosines of the axes that a direction faces, over their sum.
class Shares final : public FunctionSet {
  public:
    explicit Shares(std::vector<Vec3> axes) : axes_(std::move(axes)) {}
    [[nodiscard]] std::size_t size() const override { return axes_.size(); }
    void values(DirectionView block, float* rows) const override {
        fill_rows(axes_, {0, 0, 1, 0, 0}, 0, block, rows);
        HWY_DYNAMIC_DISPATCH(NormaliseRows)(rows, size(), block.size);
    }
    [[nodiscard]] std::span<const Vec3> axes() const { return axes_; }

  private:
    std::vector<Vec3> axes_;
};

/// E at the axes, and between them by the squared cosines of those that the normal faces, which sum to 1.
class SquaredCosines final : public LinearEvaluator {
  public:
    SquaredCosines(CosineLobe lobe, const std::vector<Vec3>& axes, double furnace)
        : shares_(axes), at_axes_(axes.size() * axes.size()), furnace_(furnace) {
        const Coefficients k = irradiance_polynomial(lobe);
        for (std::size_t i = 0; i < size(); ++i)
            for (std::size_t j = 0; j < size(); ++j) {
                const float c = dot(axes[i], axes[j]);
                at_axes_[i * size() + j] = k[0] + c * (k[1] + c * (k[2] + c * (k[3] + c * k[4])));
            }
    }
    [[nodiscard]] std::string name() const override { return "squares"; }
    [[nodiscard]] Accuracy accuracy() const override {
        return {"everywhere", "none stated: a model", Reading::of_its_own, furnace_};
    }
    [[nodiscard]] std::size_t size() const override { return shares_.size(); }
    void values(DirectionView block, float* rows) const override {
        const Scratch shares(size() * k_block_size);
        shares_.values(block, shares.data());
        kernels::transform_rows(shares.data(), size(), at_axes_.data(), block.size, rows);
    }
    void signed_irradiance(std::span<const Rgb> c, DirectionView normals, MutableColourView out) const override {
        check_evaluation(size(), c, normals, out);
        const AtAxes at_axes = irradiance_at_axes(c);
        evaluate(shares_, std::span(at_axes).first(size()), normals, out);
    }
    [[nodiscard]] Rgb signed_irradiance_at(std::span<const Rgb> c, Vec3 normal) const override {
        check_equal("coefficients", c.size(), size());
        const AtAxes at_axes = irradiance_at_axes(c);
        return evaluate(shares_, std::span(at_axes).first(size()), normal);
    }
    [[nodiscard]] Result<ShaderCode> irradiance_code() const override {
        return cosine_lobes::squares_code(shares_.axes());
    }

  private:
    static constexpr std::size_t k_most_axes = 12;
    using AtAxes = std::array<Rgb, k_most_axes>;
    /// The irradiances at the axes, of which each normal has a mean.
    [[nodiscard]] AtAxes irradiance_at_axes(std::span<const Rgb> c) const {
        AtAxes at_axes{};
        for (std::size_t i = 0; i < size(); ++i)
            for (std::size_t j = 0; j < size(); ++j) at_axes[j] = at_axes[j] + c[i] * at_axes_[i * size() + j];
        return at_axes;
    }

    Shares shares_;
    std::vector<float> at_axes_;  ///< irradiance of function i at axis j
    double furnace_;
};

const CosineLobes::Kind k_ambient_cube = {
    "ambient-cube", "ambient cube: squared clamped cosines about the six axes", Domain::sphere, {1, 0}, 0.001};

const CosineLobes::Kind k_hl2 = {
    "hl2",
    "radiosity normal mapping: squared clamped cosines about three directions across each other, 54.7 degrees off the "
    "normal",
    Domain::hemisphere,
    {1, 0},
    0.25};

const CosineLobes::Kind k_dice_srbf = {
    "dice-srbf",
    "ambient dice: radial functions .35 c^2 + .25 c^4 about the vertices of an icosahedron",
    Domain::sphere,
    {0.35f, 0.25f},
    0.001};

std::vector<Vec3> axes_of(const CosineLobes::Kind& kind) {
    const auto [a, b, c] = std::array{static_cast<float>(std::sqrt(1 / 6.0)), static_cast<float>(std::sqrt(0.5)),
                                      static_cast<float>(std::sqrt(1 / 3.0))};
    if (&kind == &k_hl2) return {{-a, b, c}, {-a, -b, c}, {2 * a, 0, c}};
    if (&kind == &k_ambient_cube) return {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    return {icosahedron::vertices().begin(), icosahedron::vertices().end()};
}

}  // namespace

double clamped_power_product(Domain domain, std::array<Vec3, 2> axes, std::array<int, 2> powers) {
    // With the pole e3 across both axes the integrand is a product of a function of height and one of azimuth.
    const Vec3 e1 = axes[0];
    Vec3 e3 = across(axes[0], axes[1]);
    const double cosine = dot(axes[0], axes[1]), between = std::acos(std::clamp(cosine, -1.0, 1.0));
    // One axis alone: a pole near the horizon's normal, so that the horizon cuts all meridians alike.
    if (between < 1e-3) e3 = cross(across(e1, {0, 0, 1}), e1);
    const Vec3 e2 = cross(e3, e1);
    const int k = (powers[0] + powers[1]) / 2;
    static const GaussLegendre unit(32, 0, 1);
    const double low = between - k_pi / 2, length = k_pi / 2 - low;
    double sum = 0;
    for (std::size_t i = 0; i < unit.nodes.size(); ++i) {
        const double phi = low + length * unit.nodes[i];
        const double along = e1.z * std::cos(phi) + e2.z * std::sin(phi);
        const double heights =
            domain == Domain::sphere ? 2 * integral_of_sine_power(k, 1) : above_horizon(k, along, e3.z);
        sum += length * unit.weights[i] * heights * std::pow(std::cos(phi), powers[0]) *
               std::pow(std::max(0.0, std::cos(phi - between)), powers[1]);
    }
    return sum;
}

std::shared_ptr<const LinearBasis> ambient_cube() {
    return std::make_shared<CosineLobes>(k_ambient_cube, axes_of(k_ambient_cube));
}

Result<std::shared_ptr<const Basis>> CosineLobes::from_name(std::string_view name) {
    for (const Kind* kind : {&k_ambient_cube, &k_hl2, &k_dice_srbf})
        if (name == kind->name)
            return std::shared_ptr<const Basis>(std::make_shared<CosineLobes>(*kind, axes_of(*kind)));
    return std::shared_ptr<const Basis>();
}

void CosineLobes::values(DirectionView block, float* rows) const {
    fill_rows(axes_, {0, 0, kind_.lobe.square, 0, kind_.lobe.fourth}, 0, block, rows);
}

Result<ShaderCode> CosineLobes::radiance_code() const { return cosine_lobes::radiance_code(kind_.lobe, axes_); }

Matrix CosineLobes::gram() const {
    Matrix g(size() * size());
    const double a = kind_.lobe.square, b = kind_.lobe.fourth;
    for (std::size_t i = 0; i < size(); ++i)
        for (std::size_t j = i; j < size(); ++j) {
            const auto product = [&](int m, int n) {
                return clamped_power_product(kind_.domain, {axes_[i], axes_[j]}, {m, n});
            };
            double sum = a * a * product(2, 2);
            if (b != 0) sum += a * b * (product(2, 4) + product(4, 2)) + b * b * product(4, 4);
            g[i * size() + j] = g[j * size() + i] = sum;
        }
    return g;
}

std::vector<double> CosineLobes::integrals() const {
    std::vector<double> result;
    for (const Vec3& axis : axes_) {
        // Over the hemisphere: what two half spaces have in common.
        const Vec3 other = kind_.domain == Domain::sphere ? axis : Vec3{0, 0, 1};
        const auto integral = [&](int m) { return clamped_power_product(Domain::sphere, {axis, other}, {m, 0}); };
        result.push_back(kind_.lobe.square * integral(2) + kind_.lobe.fourth * integral(4));
    }
    return result;
}

std::vector<std::string> CosineLobes::evaluator_names() const {
    if (kind_.lobe.fourth != 0) return {"exact"};
    return {"squares", "exact"};
}

std::shared_ptr<const Evaluator> CosineLobes::evaluator(std::string_view name) const {
    if (name == "exact") return std::make_shared<ExactCosineLobes>(kind_.lobe, axes_);
    if (name == "squares" && kind_.lobe.fourth == 0)
        return std::make_shared<SquaredCosines>(kind_.lobe, axes_, kind_.squares_furnace);
    return nullptr;
}

Basis::Rotated CosineLobes::rotated(const Rotation& r, std::span<const Rgb> c) const {
    check_equal("coefficients", c.size(), size());
    std::vector<Vec3> turned;
    for (const Vec3& axis : axes_) turned.push_back(rotate(r, axis));
    return {std::make_shared<CosineLobes>(kind_, std::move(turned)), {c.begin(), c.end()}};
}

}  // namespace lobelia
#endif
