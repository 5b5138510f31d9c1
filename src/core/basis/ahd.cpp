// Ambient and highlight: two linear unknowns given a direction, and a search for the direction.
#include "core/basis/ahd.h"

#include <algorithm>
#include <array>

#include "core/basis/sh/spherical_harmonics.h"
#include "core/math/harmonics_degree_2.h"
#include "core/math/shader_text.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/basis/ahd.cpp"
#include <hwy/foreach_target.h>  // NOLINT: must precede highway.h
#include <hwy/highway.h>
// NOLINTNEXTLINE: after highway.h
#include "core/math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lobelia::HWY_NAMESPACE {

/// out = constant + factor max(0, w . d)^(2^squarings).
void HighlightRows(const Rgb& constant, const Rgb& factor, const Vec3& axis, int squarings, DirectionView directions,
                   MutableColourView out) {
    const D d;
    const float constants[] = {constant.r, constant.g, constant.b}, factors[] = {factor.r, factor.g, factor.b};
    for (std::size_t j = 0; j < directions.size; j += hn::Lanes(d)) {
        V power = hn::Max(dot(d, axis, load(d, directions, j)), hn::Zero(d));
        for (int i = 0; i < squarings; ++i) power = hn::Mul(power, power);
        for (std::size_t k = 0; k < 3; ++k)
            store(d, hn::MulAdd(hn::Set(d, factors[k]), power, hn::Set(d, constants[k])), out.channel(k), j, out.size);
    }
}

}  // namespace lobelia::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobelia {

HWY_EXPORT(HighlightRows);

namespace {

/// The lobe that stands for the highlight: max(0, w . d)^8, squared three times.
constexpr int k_squarings = 3;
const auto k_lobe_factor = static_cast<float>((8 + 1) / (2 * k_pi));

constexpr std::size_t k_coefficients = 3, k_accumulated = 9;

using Direction = std::array<double, 3>;

/// A_0^2 + 3 A_1^2 + 5 A_2^2 over 4 pi; with all bands it is 2 pi / 3, 0.8 % more.
const double k_squared_cosine = k_pi / 4 + k_pi / 3 + 5 * k_pi / 64;

/// The light as the fit sees it: E over all normals against 1 and against max(0, n . d), up to degree 2.
class Target {
  public:
    explicit Target(std::span<const Rgb> c) : channels_{degree_2(c, 0), degree_2(c, 1), degree_2(c, 2)} {}

    struct Fit {
        std::array<double, 3> ambient{}, highlight{};
        double saved = 0;  ///< squared error that it saves against nothing at all
    };
    /// The best non-negative a and H of E = pi a + H max(0, n . d), both sides taken up to degree 2, so that such a
    /// light is found exactly. Over all normals <1, 1> = 4 pi, <1, max> = pi, <max, max> = sum A_l^2 (2l + 1) / 4 pi;
    /// <E, max> = sum A_l^2 L_l(d), L_l(d) what band l of the radiance is along d.
    [[nodiscard]] Fit at(const Direction& w) const {
        Fit fit;
        for (std::size_t k = 0; k < 3; ++k) {
            const Degree2& light = channels_[k];
            const double against = std::pow(harmonics::clamped_cosine(0), 2) * light.constant +
                                   std::pow(harmonics::clamped_cosine(1), 2) * light.first(w) +
                                   std::pow(harmonics::clamped_cosine(2), 2) * light.second(w);
            const double whole = 4 * k_pi * k_pi * light.constant;
            const double g11 = 4 * k_pi, g12 = k_pi, g22 = k_squared_cosine, determinant = g11 * g22 - g12 * g12;
            double e = (g22 * whole - g12 * against) / determinant;  // pi a
            double h = (g11 * against - g12 * whole) / determinant;
            if (h < 0) {
                h = 0;
                e = std::max(0.0, whole / g11);
            } else if (e < 0) {
                e = 0;
                h = std::max(0.0, against / g22);
            }
            fit.ambient[k] = e / k_pi;
            fit.highlight[k] = h;
            fit.saved += e * whole + h * against;
        }
        return fit;
    }

  private:
    std::array<Degree2, 3> channels_;
};

Direction unit(const Direction& v) {
    const double length = std::hypot(v[0], v[1], v[2]);
    return {v[0] / length, v[1] / length, v[2] / length};
}
Direction across(const Direction& a, const Direction& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Returns the direction of the largest saving near `d`: steps along a shrinking cross on the sphere, in double
/// precision, because values near the maximum hardly differ.
Direction searched(const Target& target, Direction d) {
    double saved = target.at(d).saved;
    for (double step = 0.4; step > 1e-6;) {
        const Direction u = unit(across(std::abs(d[2]) < 0.9 ? Direction{0, 0, 1} : Direction{1, 0, 0}, d));
        const Direction v = across(d, u);
        Direction best = d;
        bool better = false;
        for (const auto& [along, across_it] : {std::pair{step, 0.0}, {0.0, step}, {-step, 0.0}, {0.0, -step}}) {
            Direction next;
            for (std::size_t i = 0; i < 3; ++i) next[i] = d[i] + along * u[i] + across_it * v[i];
            next = unit(next);
            const double gained = target.at(next).saved;
            if (gained > saved) {
                saved = gained;
                best = next;
                better = true;
            }
        }
        if (!better) step /= 2;
        d = best;
    }
    return d;
}

class Punctual final : public Evaluator {
  public:
    [[nodiscard]] std::string name() const override { return "punctual"; }
    [[nodiscard]] Accuracy accuracy() const override {
        return {"everywhere", "exact by definition", Reading::of_its_own, 1e-5};
    }
    void signed_irradiance(std::span<const Rgb> c, DirectionView normals, MutableColourView out) const override {
        check_evaluation(k_coefficients, c, normals, out);
        HWY_DYNAMIC_DISPATCH(HighlightRows)
        (c[0] * static_cast<float>(k_pi), c[1], {c[2].r, c[2].g, c[2].b}, 0, normals, out);
    }
    [[nodiscard]] Result<ShaderCode> irradiance_code() const override {
        return ShaderCode{{},
                          "    // Ambient radiance, and a highlight of irradiance c[1] from the direction c[2].\n"
                          "    float highlight = max(dot(n, light.c[2]), 0.0);\n",
                          shader_text::literal(k_pi) + " * light.c[0] + light.c[1] * highlight"};
    }
};

}  // namespace

std::shared_ptr<const FittedBasis> ambient_highlight() { return std::make_shared<AmbientHighlight>(); }

Result<std::shared_ptr<const Basis>> AmbientHighlight::from_name(std::string_view name) {
    if (name != "ahd") return std::shared_ptr<const Basis>();
    return std::shared_ptr<const Basis>(std::make_shared<AmbientHighlight>());
}

std::shared_ptr<const LinearBasis> AmbientHighlight::accumulated() const {
    return std::make_shared<SphericalHarmonics>(2);
}

void AmbientHighlight::fit(std::span<const Rgb> accumulated, std::span<Rgb> c) const {
    check_equal("accumulated coefficients", accumulated.size(), k_accumulated);
    check_equal("coefficients", c.size(), k_coefficients);
    std::fill(c.begin(), c.end(), Rgb{});
    const Vec3 towards{luminance(accumulated[3]), luminance(accumulated[1]), luminance(accumulated[2])};
    const Target target(accumulated);
    const Direction d =
        searched(target, length(towards) > 1e-20f ? unit({towards.x, towards.y, towards.z}) : Direction{0, 0, 1});
    const Target::Fit best = target.at(d);
    const auto colour = [](const Direction& v) {
        return Rgb{static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
    };
    c[0] = colour(best.ambient);
    c[1] = colour(best.highlight);
    if (best.saved > 0) c[2] = colour(d);
}

void AmbientHighlight::radiance(std::span<const Rgb> c, DirectionView directions, MutableColourView out) const {
    check_evaluation(k_coefficients, c, directions, out);
    HWY_DYNAMIC_DISPATCH(HighlightRows)
    (c[0], c[1] * k_lobe_factor, {c[2].r, c[2].g, c[2].b}, k_squarings, directions, out);
}

Result<ShaderCode> AmbientHighlight::radiance_code() const {
    ShaderCode code{{}, "    // Spread the highlight over a lobe, the cosine to the power of 8.\n", {}};
    std::string power = "max(dot(w, light.c[2]), 0.0)";
    for (const std::string name : {"cosine", "power_2", "power_4"}) {
        code.statements += "    float " + name + " = " + power + ";\n";
        power = name + " * " + name;
    }
    code.result = "light.c[0] + light.c[1] * (" + shader_text::literal(k_lobe_factor) + " * " + power + ")";
    return code;
}

std::string AmbientHighlight::description() const { return "ambient light and one directional light"; }

std::shared_ptr<const Evaluator> AmbientHighlight::evaluator(std::string_view name) const {
    return name == "punctual" ? std::make_shared<Punctual>() : nullptr;
}

Basis::Rotated AmbientHighlight::rotated(const Rotation& r, std::span<const Rgb> c) const {
    check_equal("coefficients", c.size(), k_coefficients);
    const Vec3 d = rotate(r, {c[2].r, c[2].g, c[2].b});
    return {std::make_shared<AmbientHighlight>(), {c[0], c[1], {d.x, d.y, d.z}}};
}

}  // namespace lobelia
#endif
