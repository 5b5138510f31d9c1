// Glossy reflection of spherical Gaussians: what is the same for all views once a lobe, what is the same for all lobes
// once a view, and a formula for the two.
#include "lobelia/bases/sg_specular.h"

#include <array>

#include "lobelia/study.h"

namespace lobelia {
namespace {

constexpr auto k_pi_f = static_cast<float>(k_pi);

/// Integral of a lobe over the sphere.
float lobe_integral(float sharpness) {
    if (sharpness < 1e-4f) return 4 * k_pi_f * (1 - sharpness);
    return -2 * k_pi_f * std::expm1(-2 * sharpness) / sharpness;
}

/// The sharpness of the lobe with mean cosine 1 - `spread` (Banerjee et al. 2005; within 4 %).
float sharpness_of_spread(float spread) {
    const float r = 1 - spread;
    return r * (3 - r * r) / (std::max(spread, 1e-12f) * (2 - spread));
}

/// Where the new form passes from one end to the other: at sharpness k_middle times that of the reflection times
/// (n.v)^k_grazing, with steepness k_steepness; how soft the horizon is to masking; how far the half vector moves from
/// the normal to its own place where the light's width is carried over to normals. Fitted together by least mean error
/// at alpha .07 to .95, n.v .15 to .99, sharpness 1 to 100 (none of it where the published table is measured).
constexpr float k_middle = 2.22f, k_grazing = 0.37f, k_steepness = 1.775f, k_soft = 1.22f, k_half = 0.707f;

/// A lobe, and what the formulae want of it.
struct SgLight {
    float sharpness, integral;
    float mean, spread;  ///< mean cosine, and 1 - it with all digits
    float power;         ///< sharpness^k_steepness
    explicit SgLight(float s) : sharpness(s), integral(lobe_integral(s)) {
        // L(s) = coth s - 1 / s; below, its series.
        mean = s < 0.1f ? s / 3 - s * s * s / 45 : 1 / std::tanh(s) - 1 / s;
        spread = s < 1 ? 1 - mean : 1 / s - 2 / std::expm1(2 * s);
        power = std::pow(s, k_steepness);
    }
};

/// A view, and what the formulae want of it.
struct SgView {
    ggx::View view;
    ggx::Lobe lobe;
    Vec3 mirror;
    float alpha2, peak;  ///< the reflection in the mirror direction
    float masked;        ///< 1 + Smith's Lambda of the viewer
    float middle_power;  ///< (k_middle times the sharpness where the ends meet) ^ -k_steepness
    explicit SgView(const ggx::View& v)
        : view(v), lobe(ggx::lobe(v)), mirror{-v.sine, 0, v.cosine}, alpha2(v.alpha * v.alpha) {
        masked = 1 + static_cast<float>(ggx::smith(static_cast<double>(v.alpha), v.direction()));
        peak = 1 / (k_pi_f * alpha2 * 4 * v.cosine * (2 * masked - 1));
        const float middle = k_middle * sharpness_of_spread(lobe.spread) * std::pow(v.cosine, k_grazing);
        middle_power = std::pow(middle, -k_steepness);
    }
};

/// Share of a normalised lobe above the horizon, `cosine` its axis's z (Tokuyoshi 2022).
float share_above(float cosine, float sharpness) {
    if (sharpness < 1e-4f) return 0.5f;
    const float t =
        sharpness * std::sqrt((0.5f * sharpness + 0.65173288f) / ((sharpness + 1.34182800f) * sharpness + 7.22166878f));
    const float blend = std::clamp(0.5f + 0.5f * std::erf(t * cosine) / std::erf(t), 0.0f, 1.0f);
    const float below = std::exp(-sharpness);
    return (below + (1 - below) * blend) / (1 + below);
}

float punctual(const SgView& s, Vec3 p, const SgLight& light) {
    return light.integral * static_cast<float>(ggx::reflection(s.view, p));
}

/// The distribution as a Gaussian of sharpness 2 / alpha^2 about the normal, moved to light with its peak kept; all
/// else as in the mirror direction. Then a lobe times a lobe.
float sg_warp(const SgView& s, Vec3 p, const SgLight& light) {
    const float warped = 1 / (2 * s.alpha2 * s.view.cosine);
    const float u = length(s.mirror * warped + p * light.sharpness);
    const Vec3 apart = s.mirror - p;
    const float exponent = warped * light.sharpness * dot(apart, apart) / (u + warped + light.sharpness);
    return s.peak * std::exp(-exponent) * lobe_integral(u);
}

/// The same with two widths, across and along the plane of incidence: exp(-a x^2 - b y^2) about the mirror direction,
/// convolved with the light as exp(-nu |x|^2), nu = sharpness / 2.
float asg_warp(const SgView& s, Vec3 p, const SgLight& light) {
    const float across = 1 / (4 * s.alpha2 * s.view.cosine * s.view.cosine), along = 1 / (4 * s.alpha2);
    const float nu = light.sharpness / 2, facing = std::max(0.0f, dot(s.mirror, p));
    const float x = p.y, y = p.x * s.view.cosine + p.z * s.view.sine;
    const float exponent = nu * across / (nu + across) * x * x + nu * along / (nu + along) * y * y;
    return s.peak * k_pi_f / std::sqrt((nu + across) * (nu + along)) * facing * std::exp(-exponent);
}

/// GGX widened by a light: normals h under a symmetric GGX whose squared widths, along and across the plane of
/// incidence, have grown by the light's variance 1 / sharpness carried over to normals. In projected space a squared
/// width q is f = q / (1 - q), where the two add up.
struct Widened {
    float density;     ///< of half vectors [1/sr]
    float projection;  ///< facets' area seen by the viewer, sqrt(r v.v)
};
Widened widen(const SgView& s, Vec3 h, const SgLight& light, float cosine) {
    const float rest = 1 - s.alpha2;
    const auto wider = [&](float added) { return (s.alpha2 + added * rest) / (1 + added * rest); };
    const float along = wider(0.5f / light.sharpness);
    const float across = wider(0.5f / (light.sharpness * cosine * cosine));
    const float stretched = h.x * h.x / along + h.y * h.y / across + h.z * h.z;
    return {1 / (k_pi_f * std::sqrt(along * across) * stretched * stretched),
            std::sqrt(along * s.view.sine * s.view.sine + s.view.cosine * s.view.cosine)};
}

Vec3 half_vector(const SgView& s, Vec3 p) {
    const Vec3 sum = s.view.direction() + p;
    const float size = length(sum);
    return size > 1e-6f ? sum * (1 / size) : Vec3{0, 0, 1};
}

/// Light and reflection together, the latter as a broad Gaussian about the mirror direction: where their product lies.
struct Product {
    float cosine;  ///< of its axis to the normal
    float sharpness;
};
Product product_with_mirror(const SgView& s, Vec3 p, const SgLight& light) {
    const Vec3 u = s.mirror * ((1 - s.alpha2) / (2 * s.alpha2)) + p * light.sharpness;
    const float size = length(u);
    return {size > 0 ? u.z / size : 0, size};
}

float tokuyoshi_2024(const SgView& s, Vec3 p, const SgLight& light) {
    const Product both = product_with_mirror(s, p, light);
    const Widened wide = widen(s, half_vector(s, p), light, s.view.cosine);
    return light.integral * share_above(both.cosine, both.sharpness) * wide.density / (4 * wide.projection);
}

/// The broad end: the reflection as the Gaussian of its albedo and its mean vector, convolved with the light so that
/// mean cosines multiply. For light of degree 1 in the direction, this is exact.
float moments_lobe(const SgView& s, Vec3 p, const SgLight& light) {
    const float spread = light.spread + light.mean * s.lobe.spread;
    const float sharpness = sharpness_of_spread(spread);
    const Vec3 apart = s.lobe.axis - p;
    return s.lobe.albedo * light.integral / lobe_integral(sharpness) * std::exp(-0.5f * sharpness * dot(apart, apart));
}

/// The narrow end: the widened GGX, seen and masked as the real one is; for a punctual light, this is exact.
float masked_lobe(const SgView& s, Vec3 p, const SgLight& light) {
    const Vec3 h = half_vector(s, p);
    const Product both = product_with_mirror(s, p, light);
    const float cosine = std::max(0.05f, s.view.cosine + k_half * (dot(s.view.direction(), h) - s.view.cosine));
    const Widened wide = widen(s, h, light, cosine);

    // Mask light at the product's axis, lifted softly above the horizon.
    const float c = both.cosine, lifted = 0.5f * (c + std::sqrt(c * c + k_soft / (both.sharpness + 1)));
    const float z2 = std::min(1.0f, lifted * lifted);
    const float masking = s.masked + 0.5f * (std::sqrt(1 + s.alpha2 * (1 - z2) / z2) - 1);
    const float seen = std::sqrt(s.alpha2 * s.view.sine * s.view.sine + s.view.cosine * s.view.cosine);
    return light.integral * share_above(c, both.sharpness) * wide.density * seen /
           (4 * wide.projection * s.view.cosine * masking);
}

float two_ends(const SgView& s, Vec3 p, const SgLight& light) {
    const float t = light.power * s.middle_power, narrow = 1 - 1 / (1 + t);
    return narrow * masked_lobe(s, p, light) + (1 - narrow) * moments_lobe(s, p, light);
}

/// p is the lobe's axis in the view's frame.
float reflect_lobe(SgSpecular kind, const SgView& s, Vec3 p, const SgLight& light) {
    if (light.sharpness < 1e-8f) return s.lobe.albedo;
    switch (kind) {
        case SgSpecular::punctual:
            return punctual(s, p, light);
        case SgSpecular::sg_warp:
            return sg_warp(s, p, light);
        case SgSpecular::asg_warp:
            return asg_warp(s, p, light);
        case SgSpecular::tokuyoshi_2024:
            return tokuyoshi_2024(s, p, light);
        case SgSpecular::moments:
            return moments_lobe(s, p, light);
        case SgSpecular::masked:
            return masked_lobe(s, p, light);
        case SgSpecular::two_ends:
            return two_ends(s, p, light);
    }
    return 0;
}

constexpr std::array k_sg_speculars = {
    SgSpecularInfo{SgSpecular::punctual, "punctual", 6.6},
    SgSpecularInfo{SgSpecular::sg_warp, "sg-warp", 0.82},
    SgSpecularInfo{SgSpecular::asg_warp, "asg-warp", 0.87},
    SgSpecularInfo{SgSpecular::tokuyoshi_2024, "tokuyoshi-2024", 0.42},
    SgSpecularInfo{SgSpecular::moments, "moments", 0.62},
    SgSpecularInfo{SgSpecular::masked, "masked", 0.33},
    SgSpecularInfo{SgSpecular::two_ends, "two-ends", 0.155},
};

class SgSpecularSum final : public SpecularEvaluator {
  public:
    SgSpecularSum(const SgSpecularInfo& info, std::vector<gaussian::Lobe> lobes)
        : info_(info), lobes_(std::move(lobes)) {
        for (const auto& lobe : lobes_) lights_.emplace_back(lobe.sharpness);
    }
    [[nodiscard]] std::string name() const override { return std::string(info_.name); }
    [[nodiscard]] Accuracy accuracy() const override {
        return {"alpha 0.1 to 0.8, n.v 0.25 to 1, sharpness 2 to 64",
                table_number(info_.error) + " of a lobe's reflected light, RMS over its axes", Reading::of_radiance, 0};
    }
    void reflected(std::span<const Rgb> c, const SpecularPoints& points, MutableColourView out) const override {
        assert(c.size() == lobes_.size() && out.size == points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            const SgView seen(
                ggx::make_view(direction_at(points.normals, i), direction_at(points.views, i), points.alphas[i]));
            Rgb sum;
            for (std::size_t j = 0; j < lobes_.size(); ++j)
                sum = sum + c[j] * reflect_lobe(info_.kind, seen, seen.view.to_local(lobes_[j].axis), lights_[j]);
            set_entry(out, i, sum);
        }
    }

  private:
    const SgSpecularInfo& info_;
    std::vector<gaussian::Lobe> lobes_;
    std::vector<SgLight> lights_;
};

}  // namespace

std::span<const SgSpecularInfo> sg_specular_list() { return k_sg_speculars; }

std::optional<SgSpecular> sg_specular_from_name(std::string_view name) {
    for (const auto& entry : k_sg_speculars)
        if (entry.name == name) return entry.kind;
    return std::nullopt;
}

float sg_specular(SgSpecular kind, const gaussian::Lobe& lobe, const ggx::View& view) {
    return reflect_lobe(kind, SgView(view), view.to_local(lobe.axis), SgLight(lobe.sharpness));
}

std::vector<std::string> sg_specular_names() {
    std::vector<std::string> names;
    for (const auto& entry : k_sg_speculars) names.emplace_back(entry.name);
    return names;
}

std::shared_ptr<const SpecularEvaluator> make_sg_specular(std::string_view name, std::vector<gaussian::Lobe> lobes) {
    for (const auto& entry : k_sg_speculars)
        if (entry.name == name) return std::make_shared<SgSpecularSum>(entry, std::move(lobes));
    return nullptr;
}

}  // namespace lobelia
