// Irradiance from spherical Gaussians: constants per lobe in double precision, formulae in vector float.
#include "core/basis/sg/sg_irradiance.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <type_traits>

#include "core/basis/sg/sg_shader.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/basis/sg/sg_irradiance.cpp"
#include <hwy/foreach_target.h>  // NOLINT: must precede highway.h
#include <hwy/highway.h>
// NOLINTNEXTLINE: after highway.h
#include <hwy/contrib/math/math-inl.h>

// NOLINTNEXTLINE: after highway.h
#include "core/math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lobelia::HWY_NAMESPACE {

// Each formula takes the constants k(0), k(1), ... of a lobe and the cosine `c` between normal and axis, and gives E of
// the unit lobe. The functions of the same names in the second half of this file compute the constants. Lanes run over
// normals, for one lobe, or over lobes, at one normal.

/// The constants of one lobe, in all lanes.
struct OneLobe {
    std::span<const float> constants;
    [[nodiscard]] std::size_t size() const { return constants.size(); }
    HWY_INLINE V operator()(std::size_t i) const { return hn::Set(D(), constants[i]); }
};

/// The constants of the lobes from `first` on, one in each lane.
struct ManyLobes {
    const float* rows;
    std::size_t stride, count, first;
    [[nodiscard]] std::size_t size() const { return count; }
    HWY_INLINE V operator()(std::size_t i) const { return hn::LoadU(D(), rows + i * stride + first); }
};

/// exp(x), x <= 0, never less than e^-70: products with it stay normal floats, with others a machine is slow.
HWY_INLINE V decay(D d, V x) { return hn::Exp(d, hn::Max(x, hn::Set(d, -70.0f))); }

struct InnerProduct {
    template <class K>
    static HWY_INLINE V eval(D d, const K& k, V c) {
        // |l1 p + l2 n|, kept away from 0 where (1 - e^-2u) / u is 2.
        const V u = hn::Sqrt(hn::Max(hn::MulAdd(k(1), c, k(0)), hn::Set(d, 1e-12f)));
        const V decay = hn::Neg(hn::Expm1(d, hn::Mul(hn::Set(d, -2.0f), u)));
        return hn::Div(hn::Mul(hn::Mul(k(3), hn::Exp(d, hn::Sub(u, k(2)))), decay), u);
    }
};

struct Punctual {
    template <class K>
    static HWY_INLINE V eval(D d, const K& k, V c) {
        return hn::Mul(k(0), hn::Max(c, hn::Zero(d)));
    }
};

struct Hill {
    template <class K>
    static HWY_INLINE V eval(D d, const K& k, V c) {
        const V scale = k(0), bias = k(1), x1 = k(2);
        const V x0 = hn::Mul(hn::Set(d, 0.36f), c);
        const V knee = hn::Add(x0, x1);
        const V clamped = hn::Min(hn::Max(c, hn::Zero(d)), hn::Set(d, 1.0f));
        const V y = hn::IfThenElse(hn::Le(hn::Abs(x0), x1), hn::Mul(hn::Mul(knee, knee), k(3)), clamped);
        return hn::Mul(hn::MulAdd(scale, y, bias), k(4));
    }
};

struct Meder {
    /// Integral over the hemisphere about n of SG(sharpness), `c` the cosine between n and its axis: the integrals of
    /// the lobe's upper and lower halves, blended by a logistic; numerator and denominator are divided by e^(t + tc).
    static HWY_INLINE V hemisphere(D d, V sharpness, V c) {
        const V one = hn::Set(d, 1.0f), two_pi = hn::Set(d, static_cast<float>(2 * k_pi));
        const V numerator = hn::Mul(sharpness, hn::MulAdd(hn::Set(d, 1.6988f), sharpness, hn::Set(d, 10.8438f)));
        const V denominator = hn::MulAdd(sharpness, hn::Add(sharpness, hn::Set(d, 6.2201f)), hn::Set(d, 10.2415f));
        const V t = hn::Mul(hn::Sqrt(sharpness), hn::Div(numerator, denominator));
        const V tc = hn::Max(hn::Mul(t, c), hn::Set(d, -80.0f));
        const V rise = hn::Neg(hn::Expm1(d, hn::Neg(hn::Add(t, tc))));
        const V whole = hn::Neg(hn::Expm1(d, hn::Neg(t)));
        const V blend = hn::Div(rise, hn::Mul(whole, hn::Add(one, hn::Exp(d, hn::Neg(tc)))));
        const V upper = hn::Div(hn::Mul(two_pi, hn::Neg(hn::Expm1(d, hn::Neg(sharpness)))), sharpness);
        const V lower = hn::Mul(upper, hn::Exp(d, hn::Neg(sharpness)));
        return hn::MulAdd(blend, hn::Sub(upper, lower), lower);
    }
    template <class K>
    static HWY_INLINE V eval(D d, const K& k, V c) {
        // max(0, cos) is about 32.7080 SG(.0315) - 31.7003 on the hemisphere; the first times the lobe is a lobe.
        const V sharpness = k(0), cosine_sharpness = k(1);
        // u^2 = (l1 - l2)^2 + 2 l1 l2 (1 + c), kept away from 0 where a lobe as wide as the cosine's faces it.
        const V one = hn::Set(d, 1.0f), above = hn::Max(hn::Add(one, c), hn::Zero(d));
        const V u = hn::Sqrt(hn::MulAdd(k(2), above, k(3)));
        const V cosine = hn::Div(hn::MulAdd(sharpness, c, cosine_sharpness), u);
        // u - l1 - l2 = -2 l1 l2 (1 - c) / (u + l1 + l2), without a cancellation that 32.7 would blow up.
        const V below = hn::Max(hn::Sub(one, c), hn::Zero(d));
        const V log_amplitude =
            hn::Neg(hn::Div(hn::Mul(k(2), below), hn::Add(u, hn::Add(sharpness, cosine_sharpness))));
        const V product = hn::Mul(hn::Exp(d, log_amplitude), hemisphere(d, u, cosine));
        return hn::Sub(hn::Mul(hn::Set(d, 32.7080f), product),
                       hn::Mul(hn::Set(d, 31.7003f), hemisphere(d, sharpness, c)));
    }
};

struct Tokuyoshi {
    /// erfc with a relative error below 1.2e-7 (the Chebyshev fit in 1 / (1 + |x| / 2)).
    static HWY_INLINE V erfc(D d, V x) {
        constexpr float k_fit[] = {0.17087277f,  -0.82215223f, 1.48851587f, -1.13520398f, 0.27886807f,
                                   -0.18628806f, 0.09678418f,  0.37409196f, 1.00002368f,  -1.26551223f};
        const V z = hn::Abs(x);
        const V t = hn::Div(hn::Set(d, 1.0f), hn::MulAdd(hn::Set(d, 0.5f), z, hn::Set(d, 1.0f)));
        V fit = hn::Set(d, k_fit[0]);
        for (std::size_t i = 1; i < std::size(k_fit); ++i) fit = hn::MulAdd(fit, t, hn::Set(d, k_fit[i]));
        const V tail = hn::Mul(t, decay(d, hn::NegMulAdd(z, z, fit)));
        return hn::IfThenElse(hn::Lt(x, hn::Zero(d)), hn::Sub(hn::Set(d, 2.0f), tail), tail);
    }
    template <class K>
    static HWY_INLINE V eval(D d, const K& k, V c) {
        const V t = k(0), c2 = hn::Mul(c, c), t2 = hn::Mul(t, t);
        const V smooth = hn::MulAdd(c, erfc(d, hn::Neg(hn::Mul(t, c))), k(1));
        const V gauss =
            hn::Mul(decay(d, hn::Neg(hn::Mul(t2, c2))), hn::Expm1(d, hn::Mul(t2, hn::Sub(c2, hn::Set(d, 1.0f)))));
        const V blend = hn::NegMulAdd(gauss, k(2), hn::Mul(hn::Set(d, 0.5f), smooth));
        return hn::MulAdd(blend, k(4), k(3));
    }
};

/// N1 and N2: I (L c / 2 + sqrt(f0^2 e^(-x (k + m x)) + x r)), x = c^2, clamped at 0.
struct OddExact {
    template <class K>
    static HWY_INLINE V eval(D d, const K& k, V c) {
        const V x = hn::Mul(c, c);
        const V exponent = hn::Mul(hn::Neg(x), hn::MulAdd(k(3), x, k(2)));
        const V even = hn::Sqrt(hn::MulAdd(k(1), decay(d, exponent), hn::Mul(x, k(4))));
        return hn::Max(hn::MulAdd(k(0), c, even), hn::Zero(d));
    }
};

struct Polynomial {
    template <class K>
    static HWY_INLINE V eval(D, const K& k, V c) {
        const V x = hn::Mul(c, c);
        V even = k(4);
        for (std::size_t i = 3; i >= 1; --i) even = hn::MulAdd(even, x, k(i));
        return hn::MulAdd(k(0), c, even);
    }
};

/// Clenshaw's sum of a Legendre series; `k` holds the triples (term, (2l + 1) / (l + 1), (l + 1) / (l + 2)).
struct Exact {
    template <class K>
    static HWY_INLINE V eval(D d, const K& k, V c) {
        V e[1];
        eval_many<1>(d, k, &c, e);
        return e[0];
    }
    /// Each step waits for the one before it: several sums side by side fill the wait.
    template <std::size_t Count, class K>
    static HWY_INLINE void eval_many(D d, const K& k, const V* c, V* e) {
        V b1[Count], b2[Count];
        for (std::size_t n = 0; n < Count; ++n) b1[n] = b2[n] = hn::Zero(d);
        for (std::size_t i = k.size(); i >= 3; i -= 3) {
            const V term = k(i - 3), slope = k(i - 2), back = k(i - 1);
            for (std::size_t n = 0; n < Count; ++n) {
                const V b0 = hn::MulAdd(hn::Mul(slope, c[n]), b1[n], hn::NegMulAdd(back, b2[n], term));
                b2[n] = b1[n];
                b1[n] = b0;
            }
        }
        for (std::size_t n = 0; n < Count; ++n) e[n] = b1[n];
    }
};

template <class Formula>
void fill_row(const Vec3& axis, std::span<const float> constants, DirectionView block, float* row) {
    const D d;
    const OneLobe k{constants};
    const V px = hn::Set(d, axis.x), py = hn::Set(d, axis.y), pz = hn::Set(d, axis.z);
    const auto cosine = [&](std::size_t j) HWY_ATTR {
        const Lanes3 n = load(d, block, j);
        return hn::MulAdd(px, n.x, hn::MulAdd(py, n.y, hn::Mul(pz, n.z)));
    };
    std::size_t j = 0;
    if constexpr (std::is_same_v<Formula, Exact>) {
        constexpr std::size_t count = 4;
        for (; j + count * hn::Lanes(d) <= block.size; j += count * hn::Lanes(d)) {
            V c[count], e[count];
            for (std::size_t n = 0; n < count; ++n) c[n] = cosine(j + n * hn::Lanes(d));
            Exact::eval_many<count>(d, k, c, e);
            for (std::size_t n = 0; n < count; ++n) hn::StoreU(e[n], d, row + j + n * hn::Lanes(d));
        }
    }
    for (; j < block.size; j += hn::Lanes(d)) hn::StoreU(Formula::eval(d, k, cosine(j)), d, row + j);
}

/// Calls call(formula) with the formula of that kind.
template <class Call>
HWY_INLINE void with_formula(SgIrradiance kind, const Call& call) {
    switch (kind) {
        case SgIrradiance::inner_product:
            return call(InnerProduct());
        case SgIrradiance::punctual:
            return call(Punctual());
        case SgIrradiance::hill:
            return call(Hill());
        case SgIrradiance::meder:
            return call(Meder());
        case SgIrradiance::tokuyoshi:
            return call(Tokuyoshi());
        case SgIrradiance::odd_exact:
        case SgIrradiance::odd_exact_2:
            return call(OddExact());
        case SgIrradiance::polynomial:
            return call(Polynomial());
        case SgIrradiance::exact:
            return call(Exact());
    }
}

void FillRow(SgIrradiance kind, const Vec3& axis, std::span<const float> k, DirectionView block, float* row) {
    with_formula(kind, [&](auto formula) HWY_ATTR { fill_row<decltype(formula)>(axis, k, block, row); });
}

/// All `count` lobes at one normal. `rows` are their axes x, y, z and their `constants` constants, `stride` floats from
/// row to row, padded to whole lanes as `weights` are.
void WeightsAt(SgIrradiance kind, const float* rows, std::size_t stride, std::size_t count, std::size_t constants,
               const Vec3& n, float* weights) {
    with_formula(kind, [&](auto formula) HWY_ATTR {
        const D d;
        for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
            const Lanes3 p = {hn::LoadU(d, rows + i), hn::LoadU(d, rows + stride + i),
                              hn::LoadU(d, rows + 2 * stride + i)};
            const ManyLobes k{rows + 3 * stride, stride, constants, i};
            hn::StoreU(decltype(formula)::eval(d, k, dot(d, n, p)), d, weights + i);
        }
    });
}

/// The sum of coefficients times these weights, for at most k_few_lobes lobes; `ambient` are the lobes whose weight is
/// pi.
Rgb IrradianceAt(SgIrradiance kind, const float* rows, std::size_t stride, std::size_t constants,
                 std::span<const std::size_t> ambient, std::span<const Rgb> c, const Vec3& n) {
    alignas(64) float weights[k_few_lobes];
    WeightsAt(kind, rows, stride, c.size(), constants, n, weights);
    for (const std::size_t i : ambient) weights[i] = static_cast<float>(k_pi);
    return weighted_sum(weights, c.data(), c.size());
}

}  // namespace lobelia::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobelia {

HWY_EXPORT(FillRow);
HWY_EXPORT(WeightsAt);
HWY_EXPORT(IrradianceAt);

namespace {

using Constants = std::vector<double>;

Constants inner_product_constants(double l) {
    const double l2 = 2.133;
    return {l * l + l2 * l2, 2 * l * l2, l + l2, 1.17 * 2 * k_pi};
}

Constants punctual_constants(double l) { return {gaussian::integral(l)}; }

Constants hill_constants(double l) {
    const double e = std::exp(-l), e2 = e * e;
    const double scale = 1 + 2 * e2 - 1 / l, bias = (e - e2) / l - e2;
    const double x = std::sqrt(1 - scale);
    return {scale, bias, x / (4 * 0.36), 1 / x, gaussian::integral(l)};
}

Constants meder_constants(double l) {
    const double cosine_sharpness = 0.0315, difference = l - cosine_sharpness;
    return {l, cosine_sharpness, 2 * l * cosine_sharpness, std::max(difference * difference, 1e-12)};
}

Constants tokuyoshi_constants(double l) {
    const double a = 2.73608316113, b = 17.0212977817, c = 4.01008267285, d = 15.2191562631, f = 76.0878962724;
    const double t = l * std::sqrt(((l + a) * l + b) / (2 * (((l + c) * l + d) * l + f)));
    const double away = gaussian::irradiance(l, -1), towards = gaussian::irradiance(l, 1);
    return {t, std::erfc(t), 1 / (2 * std::sqrt(k_pi) * t), away, towards - away};
}

/// Values of the even part of E / I at cosines 0 and 1.
double even_part(const std::vector<double>& series, double c) {
    std::vector<double> even = series;
    even[1] = 0;
    return gaussian::zonal_sum(even, c) / (series[0] * 4);  // series[0] = I A_0 / (4 pi) = I / 4
}

Constants odd_exact_constants(double l, double k, double m) {
    const double integral = gaussian::integral(l), f0 = gaussian::irradiance(l, 0) / integral,
                 f1 = (gaussian::irradiance(l, 1) + gaussian::irradiance(l, -1)) / (2 * integral);
    const double slope = f1 * f1 - f0 * f0 * std::exp(-k - m);
    return {integral * gaussian::mean_cosine(l) / 2, integral * integral * f0 * f0, k, m, integral * integral * slope};
}

Constants n1_constants(double l) {
    const double b3 = .01196630;
    return odd_exact_constants(
        l, l * l * (.15544454 + l * (.02048363 + .565 * b3 * l)) / (1 + l * (.16346704 + l * (.04498634 + b3 * l))), 0);
}

Constants n2_constants(double l) {
    const double b3 = .06156752;
    return odd_exact_constants(
        l, l * l * (.17497065 + l * (.05765063 + .565 * b3 * l)) / (1 + l * (.38770256 + l * (.15044952 + b3 * l))),
        .0042626988 * l * l * l / (1 + l * (-.1534013437 + l * (.0324566805 + l * .00061038514))));
}

Constants polynomial_constants(double l) {
    const double integral = gaussian::integral(l);
    Constants k = {integral * gaussian::mean_cosine(l) / 2};
    for (double q : fit_even_part(l, 4)) k.push_back(integral * q);
    return k;
}

Constants exact_constants(double l) {
    Constants k;
    const auto series = gaussian::irradiance_series(l, 1e-10);
    for (std::size_t i = 0; i < series.size(); ++i) {
        const auto n = static_cast<double>(i);
        k.insert(k.end(), {series[i], (2 * n + 1) / (n + 1), (n + 1) / (n + 2)});
    }
    return k;
}

Constants constants(SgIrradiance kind, double sharpness) {
    switch (kind) {
        case SgIrradiance::inner_product:
            return inner_product_constants(sharpness);
        case SgIrradiance::punctual:
            return punctual_constants(sharpness);
        case SgIrradiance::hill:
            return hill_constants(sharpness);
        case SgIrradiance::meder:
            return meder_constants(sharpness);
        case SgIrradiance::tokuyoshi:
            return tokuyoshi_constants(sharpness);
        case SgIrradiance::odd_exact:
            return n1_constants(sharpness);
        case SgIrradiance::odd_exact_2:
            return n2_constants(sharpness);
        case SgIrradiance::polynomial:
            return polynomial_constants(sharpness);
        case SgIrradiance::exact:
            return exact_constants(sharpness);
    }
    return {};
}

constexpr std::array k_list = {
    SgIrradianceInfo{SgIrradiance::inner_product, "inner-product", "sharpness 0.1 to 16", 0.1, 16, 0.1},
    SgIrradianceInfo{SgIrradiance::punctual, "punctual", "sharpness 16 to 1000", 16, 1000, 0.1},
    SgIrradianceInfo{SgIrradiance::hill, "hill", "sharpness 1 to 1000", 1, 1000, 0.042},
    SgIrradianceInfo{SgIrradiance::meder, "meder", "sharpness 0.1 to 1000", 0.1, 1000, 0.012},
    SgIrradianceInfo{SgIrradiance::tokuyoshi, "tokuyoshi", "sharpness 0.1 to 1000", 0.1, 1000, 1.3e-3},
    SgIrradianceInfo{SgIrradiance::odd_exact, "odd-exact", "sharpness 0.1 to 1000", 0.1, 1000, 4.3e-4},
    SgIrradianceInfo{SgIrradiance::odd_exact_2, "odd-exact-2", "sharpness 0.1 to 1000", 0.1, 1000, 5e-5},
    SgIrradianceInfo{SgIrradiance::polynomial, "polynomial", "sharpness 0.1 to 8", 0.1, 8, 1.7e-4},
    SgIrradianceInfo{SgIrradiance::exact, "exact", "sharpness 0.1 to 1000", 0.1, 1000, 2e-6},
};

/// Sharpness 0, or so little above it that float32 cannot tell the irradiance from pi.
bool is_ambient(const gaussian::Lobe& lobe) { return lobe.sharpness < 1e-8f; }

const SgIrradianceInfo& info(SgIrradiance kind) { return k_list[static_cast<std::size_t>(kind)]; }

}  // namespace

std::span<const SgIrradianceInfo> sg_irradiance_list() { return k_list; }

std::optional<SgIrradiance> sg_irradiance_from_name(std::string_view name) {
    for (const auto& entry : k_list)
        if (entry.name == name) return entry.kind;
    return std::nullopt;
}

std::vector<double> fit_even_part(double sharpness, std::size_t count) {
    // Sample the even part at Chebyshev nodes of x = c^2 in [0, 1].
    constexpr std::size_t nodes = 200;
    const auto series = gaussian::irradiance_series(sharpness);
    const auto columns = static_cast<Eigen::Index>(count);
    Eigen::MatrixXd powers(nodes, columns);
    Eigen::VectorXd target(nodes), weight = Eigen::VectorXd::Ones(nodes);
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(nodes); ++i) {
        const double x = (1 - std::cos(k_pi * (static_cast<double>(i) + 0.5) / nodes)) / 2;
        for (Eigen::Index j = 0; j < columns; ++j) powers(i, j) = j == 0 ? 1 : powers(i, j - 1) * x;
        target(i) = even_part(series, std::sqrt(x));
    }

    // Turn least squares into minimax by Lawson's iteration: weigh each node by its error, again and again.
    Eigen::VectorXd q;
    for (int iteration = 0; iteration < 60; ++iteration) {
        const Eigen::MatrixXd weighted = powers.transpose() * weight.asDiagonal();
        q = (weighted * powers).ldlt().solve(weighted * target);
        weight.array() *= (powers * q - target).array().abs() + 1e-18;
        weight /= weight.sum();
    }
    return {q.data(), q.data() + q.size()};
}

SgIrradianceWeights::SgIrradianceWeights(SgIrradiance kind, std::vector<gaussian::Lobe> lobes)
    : kind_(kind), lobes_(std::move(lobes)) {
    for (std::size_t i = 0; i < lobes_.size(); ++i) {
        // Lobes mostly share one sharpness: then their constants are the same.
        if (i > 0 && lobes_[i].sharpness == lobes_[i - 1].sharpness) {
            constants_.push_back(constants_.back());
        } else if (is_ambient(lobes_[i])) {
            constants_.emplace_back();
        } else {
            const Constants k = constants(kind, lobes_[i].sharpness);
            constants_.emplace_back(k.begin(), k.end());
        }
    }

    // Lay axes and constants out for lanes that run over the lobes. Series end with terms of 0, which add nothing.
    for (const auto& k : constants_) constant_count_ = std::max(constant_count_, k.size());
    lobe_stride_ = round_up_to_lanes(lobes_.size());
    lobe_rows_.resize((3 + constant_count_) * lobe_stride_);
    for (std::size_t i = 0; i < lobes_.size(); ++i) {
        const Vec3& axis = lobes_[i].axis;
        std::vector<float> column = {axis.x, axis.y, axis.z};
        column.insert(column.end(), constants_[i].begin(), constants_[i].end());
        for (std::size_t k = 0; k < column.size(); ++k) lobe_rows_[k * lobe_stride_ + i] = column[k];
        if (is_ambient(lobes_[i])) ambient_.push_back(i);
    }
}

std::string SgIrradianceWeights::name() const { return std::string(info(kind_).name); }

Accuracy SgIrradianceWeights::accuracy() const {
    char text[64];
    std::snprintf(text, sizeof text, "%.2g of the lobe's integral", info(kind_).error);
    return {std::string(info(kind_).range), text};
}

void SgIrradianceWeights::values(DirectionView block, float* rows) const {
    for (std::size_t i = 0; i < lobes_.size(); ++i) {
        float* row = rows + i * k_block_size;
        if (is_ambient(lobes_[i]))
            std::fill_n(row, block.size, static_cast<float>(k_pi));
        else
            HWY_DYNAMIC_DISPATCH(FillRow)(kind_, lobes_[i].axis, constants_[i], block, row);
    }
}

void SgIrradianceWeights::values_at(Vec3 normal, float* values) const {
    if (constant_count_ > 0) HWY_DYNAMIC_DISPATCH(WeightsAt)
    (kind_, lobe_rows_.data(), lobe_stride_, lobes_.size(), constant_count_, normal, values);
    for (const std::size_t i : ambient_) values[i] = static_cast<float>(k_pi);
}

Rgb SgIrradianceWeights::signed_irradiance_at(std::span<const Rgb> c, Vec3 normal) const {
    check_equal("coefficients", c.size(), size());
    if (size() > k_few_lobes) return evaluate(*this, c, normal);
    return HWY_DYNAMIC_DISPATCH(IrradianceAt)(kind_, lobe_rows_.data(), lobe_stride_, constant_count_, ambient_, c,
                                              normal);
}

Result<ShaderCode> SgIrradianceWeights::irradiance_code() const {
    return sg_shader::irradiance(kind_, lobes_, constants_);
}

std::vector<float> sg_irradiance(SgIrradiance kind, double sharpness, std::span<const float> cosines) {
    Directions normals(cosines.size());
    for (std::size_t i = 0; i < cosines.size(); ++i) {
        const float c = cosines[i];
        set_entry(normals.view(), i, Vec3{std::sqrt(std::max(0.0f, 1 - c * c)), 0, c});
    }
    const SgIrradianceWeights weights(kind, {{Vec3{0, 0, 1}, static_cast<float>(sharpness)}});
    Colours irradiance(cosines.size());
    const Rgb one{1, 1, 1};
    weights.signed_irradiance(std::span(&one, 1), normals, irradiance);
    return {irradiance.channel(0), irradiance.channel(0) + cosines.size()};
}

}  // namespace lobelia
#endif
