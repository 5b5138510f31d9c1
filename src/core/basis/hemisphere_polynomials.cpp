// The H-basis: values, irradiance above the horizon, rotation about the normal. Abramowitz and Stegun 1964 (the arc
// cosine of the shader code).
#include "core/basis/hemisphere_polynomials.h"

#include "core/math/kernels.h"
#include "core/math/quadrature.h"
#include "core/math/shader_pattern.h"
#include "core/math/shader_text.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/basis/hemisphere_polynomials.cpp"
#include <hwy/foreach_target.h>  // NOLINT: must precede highway.h
#include <hwy/highway.h>
// NOLINTNEXTLINE: after highway.h
#include <hwy/contrib/math/math-inl.h>

// NOLINTNEXTLINE: after highway.h
#include "core/math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lobelia::HWY_NAMESPACE {

/// rows = k0, k1 y, k1 (2z - 1), k1 x, k2 xy, k2 (x^2 - y^2) / 2.
void PolynomialRows(std::size_t count, const float* k, DirectionView block, float* rows) {
    const D d;
    const V k1 = hn::Set(d, k[1]), k2 = hn::Set(d, k[2]);
    for (std::size_t j = 0; j < block.size; j += hn::Lanes(d)) {
        const auto [x, y, z] = load(d, block, j);
        hn::StoreU(hn::Set(d, k[0]), d, rows + j);
        hn::StoreU(hn::Mul(k1, y), d, rows + k_block_size + j);
        hn::StoreU(hn::Mul(k1, hn::Sub(hn::Add(z, z), hn::Set(d, 1.0f))), d, rows + 2 * k_block_size + j);
        hn::StoreU(hn::Mul(k1, x), d, rows + 3 * k_block_size + j);
        if (count < 6) continue;
        hn::StoreU(hn::Mul(k2, hn::Mul(x, y)), d, rows + 4 * k_block_size + j);
        const V difference = hn::NegMulAdd(y, y, hn::Mul(x, x));
        hn::StoreU(hn::Mul(hn::Mul(k2, hn::Set(d, 0.5f)), difference), d, rows + 5 * k_block_size + j);
    }
}

void HorizonRows(std::size_t count, DirectionView block, float* rows) {
    const D d;
    const auto pi = static_cast<float>(k_pi);
    const V one = hn::Set(d, 1.0f);
    for (std::size_t j = 0; j < block.size; j += hn::Lanes(d)) {
        const auto [x, y, z] = load(d, block, j);
        const V c = hn::Min(hn::Max(z, hn::Set(d, -1.0f)), one);
        const V sine = hn::Sqrt(hn::Max(hn::NegMulAdd(c, c, one), hn::Zero(d)));
        const V rest = hn::Sub(hn::Set(d, pi), hn::Acos(d, c));  // pi - g
        const V slope = hn::Mul(hn::Set(d, 2.0f / 3), rest);
        hn::StoreU(hn::MulAdd(hn::Set(d, pi / 2), c, hn::Set(d, pi / 2)), d, rows + j);
        hn::StoreU(hn::Mul(slope, y), d, rows + k_block_size + j);
        hn::StoreU(hn::Mul(hn::Set(d, 2.0f / 3), hn::MulAdd(rest, c, sine)), d, rows + 2 * k_block_size + j);
        hn::StoreU(hn::Mul(slope, x), d, rows + 3 * k_block_size + j);
        if (count < 6) continue;
        hn::StoreU(hn::Mul(hn::Set(d, pi / 8), hn::Mul(x, y)), d, rows + 4 * k_block_size + j);
        const V difference = hn::NegMulAdd(y, y, hn::Mul(x, x));
        hn::StoreU(hn::Mul(hn::Set(d, pi / 16), difference), d, rows + 5 * k_block_size + j);
    }
}

}  // namespace lobelia::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobelia {

HWY_EXPORT(PolynomialRows);
HWY_EXPORT(HorizonRows);

namespace {

/// The code of the sum of coefficients times combinations of the polynomials, row i of the matrix for coefficient i.
ShaderCode polynomial_code(const std::vector<double>& matrix, const std::string& direction, const std::string& name) {
    using shader_text::literal;
    const auto count = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(matrix.size()))));
    const std::string x = direction + ".x", y = direction + ".y", z = direction + ".z";
    const double k0 = HemispherePolynomials::factor(0), k1 = HemispherePolynomials::factor(1),
                 k2 = HemispherePolynomials::factor(2);
    std::vector<std::string> weights;
    for (std::size_t i = 0; i < count; ++i) {
        // Turn the combination into one of the monomials z, 1, y, x, xy, x^2 - y^2.
        const auto m = [&](std::size_t k) { return k < count ? matrix[i * count + k] : 0; };
        const std::pair<double, std::string> terms[] = {
            {2 * k1 * m(2), " * " + z},
            {k0 * m(0) - k1 * m(2), ""},
            {k1 * m(1), " * " + y},
            {k1 * m(3), " * " + x},
            {k2 * m(4), " * " + x + " * " + y},
            {k2 * m(5) / 2, " * (" + x + " * " + x + " - " + y + " * " + y + ")"}};
        std::string weight;
        for (const auto& [factor, monomial] : terms) {
            if (std::abs(factor) < 1e-7) continue;
            weight += weight.empty() ? literal(factor) + monomial
                                     : (factor < 0 ? " - " : " + ") + literal(std::abs(factor)) + monomial;
        }
        weights.push_back(weight.empty() ? "0.0" : weight);
    }
    return shader_text::sum_of(weights, name);
}

/// An arc cosine of its own: those of Mesa and of AMD are off by up to 1.6e-4.
constexpr std::string_view k_arc_cosine =
    R"(/// Returns the arc cosine, within 1e-6 (Abramowitz and Stegun 1964, 4.4.46).
float arc_cosine(float cosine) {
    float x = min(abs(cosine), 1.0);
    float p = 0.0308918810 + x * (-0.0170881256 + x * (0.0066700901 - x * 0.0012624911));
    p = 1.5707963050 + x * (-0.2145988016 + x * (0.0889789874 + x * (-0.0501743046 + x * p)));
    float angle = sqrt(1.0 - x) * p;
    return choose(cosine < 0.0, 3.1415927 - angle, angle);
}
)";

/// The code of the exact irradiance: that of 1, z, y, x, xy and x^2 - y^2 above the horizon.
ShaderCode horizon_code(std::size_t count) {
    using shader_text::filled, shader_text::literal;
    const double k0 = HemispherePolynomials::factor(0), k1 = HemispherePolynomials::factor(1),
                 k2 = HemispherePolynomials::factor(2);
    const std::string flat = literal(k0 * k_pi / 2), up = literal(k1 * k_pi / 2);
    std::vector<std::string> weights = {filled("$0 * n.z + $0", {flat}),
                                        filled("$0 * angle * n.y", {literal(k1 * 2 / 3)}),
                                        filled("$0 * (angle * n.z + sine) - $1 * n.z - $1", {literal(k1 * 4 / 3), up}),
                                        filled("$0 * angle * n.x", {literal(k1 * 2 / 3)})};
    if (count == 6) {
        weights.push_back(filled("$0 * n.x * n.y", {literal(k2 * k_pi / 8)}));
        weights.push_back(filled("$0 * (n.x * n.x - n.y * n.y)", {literal(k2 * k_pi / 16)}));
    }
    ShaderCode code = shader_text::sum_of(weights, "e");
    code.functions.push_back({"arc_cosine", std::string(k_arc_cosine)});
    code.statements =
        R"(    // Irradiance of what is above the horizon (Habel and Wimmer 2010), by the angle between the normal and -z.
    float angle = arc_cosine(-n.z);
    float sine = sqrt(max(1.0 - n.z * n.z, 0.0));
)" + code.statements;
    return code;
}

/// Exact irradiance of what is above the horizon.
class ExactAboveHorizon final : public LinearEvaluator {
  public:
    explicit ExactAboveHorizon(std::size_t count) : irradiance_(count) {}
    [[nodiscard]] std::string name() const override { return "exact"; }
    [[nodiscard]] Accuracy accuracy() const override {
        return {"everywhere", "4e-6 of the largest E (float32 rounding)"};
    }
    [[nodiscard]] std::size_t size() const override { return irradiance_.size(); }
    void values(DirectionView block, float* rows) const override {
        irradiance_.values(block, rows);
        // Convert monomials to the basis: row 2 belongs to 2z - 1.
        const auto k0 = static_cast<float>(HemispherePolynomials::factor(0)),
                   k1 = static_cast<float>(HemispherePolynomials::factor(1)),
                   k2 = static_cast<float>(HemispherePolynomials::factor(2));
        for (std::size_t j = 0; j < block.size; ++j) {
            float& up = rows[2 * k_block_size + j];
            up = 2 * up - rows[j];
        }
        const float factors[] = {k0, k1, k1, k1, k2, k2};
        for (std::size_t i = 0; i < size(); ++i)
            for (std::size_t j = 0; j < block.size; ++j) rows[i * k_block_size + j] *= factors[i];
    }

    [[nodiscard]] Result<ShaderCode> irradiance_code() const override { return horizon_code(size()); }

  private:
    HorizonIrradiance irradiance_;
};

/// The nearest combination of the basis's own polynomials to the exact irradiance, over the upper normals.
class Projected final : public LinearEvaluator {
  public:
    explicit Projected(std::size_t count) : basis_(count) {
        for (double m : inner_products(ExactAboveHorizon(count), basis_, product_rule(Domain::hemisphere, 24)))
            matrix_.push_back(static_cast<float>(m));
    }
    [[nodiscard]] std::string name() const override { return "projected"; }
    [[nodiscard]] Accuracy accuracy() const override {
        return {"normals above the horizon", "0.18 for each unit of a coefficient, near the horizon",
                Reading::of_its_own, 1e-4};
    }
    [[nodiscard]] std::size_t size() const override { return basis_.size(); }
    void values(DirectionView block, float* rows) const override {
        std::array<float, 6 * k_block_size> own;
        basis_.values(block, own.data());
        kernels::transform_rows(own.data(), size(), matrix_.data(), block.size, rows);
    }

    [[nodiscard]] Result<ShaderCode> irradiance_code() const override {
        ShaderCode code = polynomial_code({matrix_.begin(), matrix_.end()}, "n", "e");
        code.statements = "    // The polynomials nearest to irradiance above the horizon (Habel and Wimmer 2010).\n" +
                          code.statements;
        return code;
    }

  private:
    HemispherePolynomials basis_;
    std::vector<float> matrix_;
};

}  // namespace

void HorizonIrradiance::values(DirectionView block, float* rows) const {
    HWY_DYNAMIC_DISPATCH(HorizonRows)(count_, block, rows);
}

std::shared_ptr<const LinearBasis> hemisphere_polynomials(std::size_t count) {
    check_equal("polynomials, unless they are 4", count, count == 4 ? 4 : 6);
    return std::make_shared<HemispherePolynomials>(count);
}

Result<std::shared_ptr<const Basis>> HemispherePolynomials::from_name(std::string_view name) {
    for (const std::size_t count : {4u, 6u}) {
        auto basis = std::make_shared<HemispherePolynomials>(count);
        if (basis->name() == name) return std::shared_ptr<const Basis>(std::move(basis));
    }
    return std::shared_ptr<const Basis>();
}

void HemispherePolynomials::values(DirectionView block, float* rows) const {
    const float k[] = {static_cast<float>(factor(0)), static_cast<float>(factor(1)), static_cast<float>(factor(2))};
    HWY_DYNAMIC_DISPATCH(PolynomialRows)(count_, k, block, rows);
}

Result<ShaderCode> HemispherePolynomials::radiance_code() const {
    ShaderCode code = polynomial_code(gram(), "w", "sum");
    code.statements = "    // Polynomials orthonormal over the hemisphere (Habel and Wimmer 2010).\n" + code.statements;
    return code;
}

std::string HemispherePolynomials::description() const {
    return "H-basis: " + std::to_string(count_) + " polynomials orthonormal over the hemisphere";
}

Matrix HemispherePolynomials::gram() const {
    Matrix identity(count_ * count_);
    for (std::size_t i = 0; i < count_; ++i) identity[i * count_ + i] = 1;
    return identity;
}

std::vector<double> HemispherePolynomials::integrals() const {
    std::vector<double> result(count_);
    result[0] = std::sqrt(2 * k_pi);
    return result;
}

std::shared_ptr<const Evaluator> HemispherePolynomials::evaluator(std::string_view name) const {
    if (name == "exact") return std::make_shared<ExactAboveHorizon>(count_);
    if (name == "projected") return std::make_shared<Projected>(count_);
    return nullptr;
}

Basis::Rotated HemispherePolynomials::rotated(const Rotation& r, std::span<const Rgb> c) const {
    check_equal("coefficients", c.size(), size());
    // About z by the angle t: (x, y) as a vector, (x^2 - y^2, 2xy) as one turned by 2t.
    const float cosine = r[0].x, sine = r[1].x;
    std::vector<Rgb> turned(c.begin(), c.end());
    turned[3] = c[3] * cosine - c[1] * sine;
    turned[1] = c[3] * sine + c[1] * cosine;
    if (count_ == 6) {
        const float twice_cosine = cosine * cosine - sine * sine, twice_sine = 2 * sine * cosine;
        turned[5] = c[5] * twice_cosine - c[4] * twice_sine;
        turned[4] = c[5] * twice_sine + c[4] * twice_cosine;
    }
    return {std::make_shared<HemispherePolynomials>(count_), std::move(turned)};
}

}  // namespace lobelia
#endif
