// Irradiance from spherical harmonics: linear forms by band factors, models of degree 1, the search behind deringing.
#include "core/basis/sh/sh_irradiance.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>

#include "core/basis/sh/sh_shader.h"
#include "core/math/harmonics_degree_2.h"
#include "core/math/scratch.h"
#include "core/math/zonal_quadratic.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/basis/sh/sh_irradiance.cpp"
#include <hwy/foreach_target.h>  // NOLINT: must precede highway.h
#include <hwy/highway.h>
// NOLINTNEXTLINE: after highway.h
#include <hwy/contrib/math/math-inl.h>

// NOLINTNEXTLINE: after highway.h
#include "core/math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lobelia::HWY_NAMESPACE {

/// out = scale (a + b q^p), q = (1 + w . axis) / 2.
void PowerRow(const Vec3& axis, const float* scale_a_b_p, DirectionView directions, float* out) {
    const D d;
    const V half = hn::Set(d, 0.5f), a = hn::Set(d, scale_a_b_p[0] * scale_a_b_p[1]),
            b = hn::Set(d, scale_a_b_p[0] * scale_a_b_p[2]), p = hn::Set(d, scale_a_b_p[3]);
    for (std::size_t j = 0; j < directions.size; j += hn::Lanes(d)) {
        const V q = hn::Max(hn::MulAdd(half, dot(d, axis, load(d, directions, j)), half), hn::Set(d, 1e-12f));
        const V power = hn::Exp(d, hn::Mul(p, hn::Log(d, q)));
        store(d, hn::MulAdd(b, power, a), out, j, directions.size);
    }
}

}  // namespace lobelia::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobelia {

HWY_EXPORT(PowerRow);

namespace {

using harmonics::Harmonics;

/// Calls visit(l, i) for every coefficient i of every band l.
template <class Visit>
void for_each_coefficient(std::size_t degree, const Visit& visit) {
    for (std::size_t l = 0; l <= degree; ++l)
        for (std::size_t i = l * l; i < (l + 1) * (l + 1); ++i) visit(l, i);
}

/// The coefficients times the factors of their bands, in `memory`, which has three floats for each.
std::span<const Rgb> damped(std::size_t degree, std::span<const Rgb> c, std::span<const double> factors,
                            const Scratch& memory) {
    check_equal("coefficients", c.size(), harmonics::coefficient_count(degree));
    Rgb* const result = new (memory.data()) Rgb[c.size()];
    for_each_coefficient(degree,
                         [&](std::size_t l, std::size_t i) { result[i] = c[i] * static_cast<float>(factors[l]); });
    return {result, c.size()};
}

std::vector<double> convolved(std::vector<double> window) {
    for (std::size_t l = 0; l < window.size(); ++l) window[l] *= harmonics::clamped_cosine(l);
    return window;
}

/// E(n) = sum f_l A_l L_lm Y_lm(n).
class BandFactors final : public LinearEvaluator {
  public:
    BandFactors(std::string name, std::vector<double> window, Negative negative, Reading reading)
        : name_(std::move(name)),
          harmonics_(window.size() - 1),
          factors_(convolved(std::move(window))),
          float_factors_(factors_.begin(), factors_.end()),
          negative_(negative),
          reading_(reading) {}
    [[nodiscard]] std::string name() const override { return name_; }
    [[nodiscard]] Negative negative() const override { return negative_; }
    [[nodiscard]] Accuracy accuracy() const override {
        return {"every degree", "1e-6 of the largest E (float32 rounding)", reading_};
    }
    [[nodiscard]] std::size_t size() const override { return harmonics_.size(); }
    void values(DirectionView block, float* rows) const override {
        harmonics_.values(block, rows);
        for_each_coefficient(harmonics_.degree(), [&](std::size_t l, std::size_t i) {
            const auto scale = static_cast<float>(factors_[l]);
            for (std::size_t j = 0; j < block.size; ++j) rows[i * k_block_size + j] *= scale;
        });
    }
    void values_at(Vec3 direction, float* values) const override {
        harmonics_.values_at(direction, values);
        for_each_coefficient(harmonics_.degree(),
                             [&](std::size_t l, std::size_t i) { values[i] *= float_factors_[l]; });
    }
    void signed_irradiance(std::span<const Rgb> c, DirectionView normals, MutableColourView out) const override {
        const Scratch memory(3 * c.size());
        harmonics_.sum(damped(harmonics_.degree(), c, factors_, memory), normals, out);
    }
    [[nodiscard]] Rgb signed_irradiance_at(std::span<const Rgb> c, Vec3 normal) const override {
        return harmonics_.sum_at(c, float_factors_, normal);
    }
    [[nodiscard]] Result<ShaderCode> irradiance_code() const override {
        return sh_shader::irradiance(factors_, reading_ == Reading::of_radiance ? "" : name_);
    }

  private:
    std::string name_;
    Harmonics harmonics_;
    std::vector<double> factors_;
    std::vector<float> float_factors_;
    Negative negative_;
    Reading reading_;
};

/// An evaluator that is a model: a function that reads one set of coefficients at many normals.
class Model final : public Evaluator {
  public:
    using Read = std::function<void(std::span<const Rgb>, DirectionView, MutableColourView)>;
    Model(std::string name, std::string range, std::size_t degree, Read read, Result<ShaderCode> code)
        : name_(std::move(name)),
          range_(std::move(range)),
          coefficients_(harmonics::coefficient_count(degree)),
          read_(std::move(read)),
          code_(std::move(code)) {}
    [[nodiscard]] std::string name() const override { return name_; }
    [[nodiscard]] Negative negative() const override { return Negative::clamped; }
    [[nodiscard]] Accuracy accuracy() const override {
        return {range_, "none stated: a model", Reading::of_its_own, 1e-5};
    }
    void signed_irradiance(std::span<const Rgb> c, DirectionView normals, MutableColourView out) const override {
        check_evaluation(coefficients_, c, normals, out);
        read_(c, normals, out);
    }
    [[nodiscard]] Result<ShaderCode> irradiance_code() const override { return code_; }

  private:
    std::string name_, range_;
    std::size_t coefficients_;
    Read read_;
    Result<ShaderCode> code_;
};

/// Band 1 of one channel as a vector.
Vec3 vector_of(std::span<const Rgb> c, std::size_t k) {
    return {channel_of(c[3], k), channel_of(c[1], k), channel_of(c[2], k)};
}
Vec3 normalized_or_up(Vec3 v) { return length(v) > 1e-20f ? normalize(v) : Vec3{0, 0, 1}; }

/// E / pi = R0 (a + (1 - a) (p + 1) q^p), R0 the mean radiance, R1 the mean of L w, q = (1 + n . R1 / |R1|) / 2: it has
/// the mean of the linear form, is exact at both ends of a single light and in a constant environment, and is never
/// negative.
void read_geomerics(std::span<const Rgb> c, DirectionView normals, MutableColourView out) {
    for (std::size_t k = 0; k < 3; ++k) {
        const double r0 = channel_of(c[0], k) / (2 * std::sqrt(k_pi));
        const Vec3 r1 = vector_of(c, k);
        const double along = length(r1) / std::sqrt(3.0) / std::max(1e-30, static_cast<double>(channel_of(c[0], k)));
        const double share = r0 > 0 ? std::min(1.0, along) : 0;  // |R1| / R0; noise may take it past 1
        const double a = (1 - share) / (1 + share), p = 1 + 2 * share;
        const float constants[4] = {static_cast<float>(k_pi * r0), static_cast<float>(a),
                                    static_cast<float>((1 - a) * (p + 1)), static_cast<float>(p)};
        HWY_DYNAMIC_DISPATCH(PowerRow)(normalized_or_up(r1), constants, normals, out.channel(k));
    }
}

/// Degree 2 guessed from degree 1: zonal about the axis of the luminance, z = L0 (.08 r + .6 r^2), r = |L1 . axis| /
/// L0.
void read_hallucinated(std::span<const Rgb> c, DirectionView normals, MutableColourView out) {
    const Vec3 axis = normalized_or_up({luminance(c[3]), luminance(c[1]), luminance(c[2])});
    std::array<ZonalQuadratic, 3> e;
    for (std::size_t k = 0; k < 3; ++k) {
        const double l0 = channel_of(c[0], k);
        const Vec3 l1 = vector_of(c, k);
        const double ratio = l0 > 0 ? std::abs(dot(l1, axis)) / l0 : 0;
        const double z = l0 * (0.08 + 0.6 * ratio) * ratio;
        e[k].constant = static_cast<float>(k_pi * std::sqrt(1 / (4 * k_pi)) * l0);
        e[k].linear = l1 * static_cast<float>(2 * k_pi / 3 * std::sqrt(3 / (4 * k_pi)));
        e[k].quadratic = static_cast<float>(k_pi / 4 * std::sqrt(5 / (4 * k_pi)) * z);
        e[k].axis = axis;
    }
    evaluate(e, normals, out);
}

// ---- The least value, and the window that lifts it to 0 ----

/// One place where a channel is low, found on a fixed set of directions; then made exact by fitting a quadratic to a
/// small grid about it, again and again.
class LeastValue {
  public:
    explicit LeastValue(std::size_t degree)
        : harmonics_(degree), directions_(k_directions), values_(k_directions), near_(9), near_values_(9) {
        const double turn = k_pi * (3 - std::sqrt(5.0));
        for (std::size_t i = 0; i < k_directions; ++i) {
            const double z = 1 - (2 * static_cast<double>(i) + 1) / k_directions, r = std::sqrt(1 - z * z);
            const double phi = turn * static_cast<double>(i);
            set_entry(directions_.view(), i,
                      Vec3{static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)),
                           static_cast<float>(z)});
        }
    }

    /// The least of all channels.
    [[nodiscard]] double operator()(std::span<const Rgb> c) {
        harmonics_.sum(c, directions_, values_);
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < 3; ++k) {
            const float* channel = values_.channel(k);
            const auto lowest = static_cast<std::size_t>(std::min_element(channel, channel + k_directions) - channel);
            least = std::min(least, polished(c, k, direction_at(directions_.view(), lowest)));
        }
        return least;
    }

  private:
    /// Enough for degree 8, whose least waves are 0.8 wide: the nearest direction is 0.1 away.
    static constexpr std::size_t k_directions = 512;

    [[nodiscard]] double polished(std::span<const Rgb> c, std::size_t k, Vec3 centre) {
        double least = std::numeric_limits<double>::infinity();
        for (float step = 0.08f; step > 0.004f; step *= 0.4f) {
            const Vec3 a = normalize(cross(centre, std::abs(centre.z) < 0.9f ? Vec3{0, 0, 1} : Vec3{1, 0, 0}));
            const Vec3 b = cross(centre, a);
            for (std::size_t i = 0; i < 9; ++i) {
                const float u = static_cast<float>(i % 3) - 1, v = static_cast<float>(i / 3) - 1;
                set_entry(near_.view(), i, normalize(centre + a * (u * step) + b * (v * step)));
            }
            harmonics_.sum(c, near_, near_values_);
            const float* f = near_values_.channel(k);
            least = std::min(least, static_cast<double>(*std::min_element(f, f + 9)));
            // The minimum of the quadratic through the nine values, at most one step away.
            const float fu = (f[5] - f[3]) / 2, fv = (f[7] - f[1]) / 2;
            const float fuu = f[5] - 2 * f[4] + f[3], fvv = f[7] - 2 * f[4] + f[1];
            const float fuv = (f[8] - f[6] - f[2] + f[0]) / 4;
            const float determinant = fuu * fvv - fuv * fuv;
            const bool bowl = fuu > 0 && determinant > 0;
            const float u = bowl ? (fuv * fv - fvv * fu) / determinant : 0;
            const float v = bowl ? (fuv * fu - fuu * fv) / determinant : 0;
            centre =
                normalize(centre + a * (std::clamp(u, -1.0f, 1.0f) * step) + b * (std::clamp(v, -1.0f, 1.0f) * step));
        }
        return least;
    }

    Harmonics harmonics_;
    Directions directions_;
    Colours values_;
    Directions near_;
    Colours near_values_;
};

Model::Read dering_reader(std::size_t degree) {
    return
        [harmonics = Harmonics(degree), degree](std::span<const Rgb> c, DirectionView normals, MutableColourView out) {
            const double w = sufficient_window(degree, c);
            const Scratch memory(3 * c.size());
            harmonics.sum(damped(degree, c, convolved(dering_window(degree, w)), memory), normals, out);
        };
}

template <class Factor>
std::vector<double> window(std::size_t degree, const Factor& factor) {
    std::vector<double> factors(degree + 1);
    for (std::size_t l = 0; l <= degree; ++l) factors[l] = l == 0 ? 1 : factor(static_cast<double>(l));
    return factors;
}

double sinc(double x) { return x == 0 ? 1 : std::sin(x) / x; }

}  // namespace

std::vector<double> hann_window(std::size_t degree) {
    const auto w = static_cast<double>(degree + 1);
    return window(degree, [&](double l) { return (1 + std::cos(k_pi * l / w)) / 2; });
}

std::vector<double> lanczos_window(std::size_t degree) {
    const auto w = static_cast<double>(degree + 1);
    return window(degree, [&](double l) { return sinc(k_pi * l / w); });
}

std::vector<double> laplacian_window(std::size_t degree) {
    const double highest = static_cast<double>(degree * (degree + 1));
    return window(degree, [&](double l) { return 1 / (1 + std::pow(l * (l + 1) / highest, 2)); });
}

std::vector<double> dering_window(std::size_t degree, double w) {
    return window(degree, [&](double l) { return std::pow(sinc(k_pi * l / w), 4); });
}

double least_value(std::size_t degree, std::span<const Rgb> c) { return LeastValue(degree)(c); }

double sufficient_window(std::size_t degree, std::span<const Rgb> c) {
    LeastValue least(degree);
    const Scratch memory(3 * c.size());
    const auto is_enough = [&](double inverse) {
        const auto factors = convolved(dering_window(degree, 1 / inverse));
        return least(damped(degree, c, factors, memory)) >= 0;
    };
    // At w = 1 the mean alone is left; bisect 1 / w between that and no window.
    const double none = std::numeric_limits<double>::infinity();
    if (is_enough(0)) return none;
    double low = 0, high = 1;
    for (int i = 0; i < 16; ++i) {
        const double middle = (low + high) / 2;
        (is_enough(middle) ? high : low) = middle;
    }
    return 1 / high;
}

std::vector<std::string> sh_evaluator_names(std::size_t degree) {
    std::vector<std::string> names = {"convolution"};
    // Irradiance has next to nothing beyond degree 4, and so do the windows to mend.
    if (degree <= 4) names.insert(names.end(), {"hann", "lanczos", "laplacian", "dering"});
    if (degree == 1) names.insert(names.end(), {"geomerics", "zh3-hallucinated"});
    names.emplace_back("convolution-signed");
    return names;
}

std::shared_ptr<const Evaluator> sh_evaluator(std::string_view name, std::size_t degree) {
    const auto linear = [&](const std::vector<double>& factors, Negative negative, Reading reading) {
        return std::make_shared<BandFactors>(std::string(name), factors, negative, reading);
    };
    const std::vector<double> none(degree + 1, 1.0);
    if (name == "convolution") return linear(none, Negative::clamped, Reading::of_radiance);
    if (name == "convolution-signed") return linear(none, Negative::kept, Reading::of_radiance);
    if (name == "hann") return linear(hann_window(degree), Negative::clamped, Reading::of_its_own);
    if (name == "lanczos") return linear(lanczos_window(degree), Negative::clamped, Reading::of_its_own);
    if (name == "laplacian") return linear(laplacian_window(degree), Negative::clamped, Reading::of_its_own);
    const auto model = [&](const char* range, Model::Read read, Result<ShaderCode> code) {
        return std::make_shared<Model>(std::string(name), range, degree, std::move(read), std::move(code));
    };
    if (name == "dering")
        return model("every degree", dering_reader(degree),
                     Error{"evaluator dering has no shader code: it searches for the window of each set of "
                           "coefficients; apply the window before, or use hann, lanczos or laplacian"});
    if (degree != 1) return nullptr;
    if (name == "geomerics") return model("degree 1", read_geomerics, sh_shader::geomerics());
    if (name == "zh3-hallucinated") return model("degree 1", read_hallucinated, sh_shader::hallucinated());
    return nullptr;
}

}  // namespace lobelia
#endif
