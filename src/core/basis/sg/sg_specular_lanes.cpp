// Formulae of glossy reflection of spherical Gaussians in vector float, lanes running over views.
// Wang et al. 2009; Xu et al. 2013; Pettineo 2016 (part 4); Tokuyoshi 2022; Tokuyoshi et al. 2024.
#include "core/basis/sg/sg_specular_lanes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/basis/sg/sg_specular_lanes.cpp"
#include <hwy/foreach_target.h>  // NOLINT: must precede highway.h
#include <hwy/highway.h>
// NOLINTNEXTLINE: after highway.h
#include <hwy/contrib/math/math-inl.h>

#include "core/math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lobelia::HWY_NAMESPACE {

constexpr auto k_gloss_pi = static_cast<float>(k_pi);

HWY_INLINE V value(float v) { return hn::Set(D(), v); }
HWY_INLINE V square(V a) { return hn::Mul(a, a); }
HWY_INLINE V inverse(V a) { return hn::Div(value(1), a); }
/// a x^2 + b y^2 + c z^2.
HWY_INLINE V quadratic(V a, V b, V c, const Lanes3& v) {
    return hn::MulAdd(a, square(v.x), hn::MulAdd(b, square(v.y), hn::Mul(c, square(v.z))));
}
HWY_INLINE V dot(const Lanes3& a, const Lanes3& b) {
    return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}
/// |a - b|^2.
HWY_INLINE V apart(const Lanes3& a, const Lanes3& b) {
    return hn::Add(square(hn::Sub(a.x, b.x)), hn::Add(square(hn::Sub(a.y, b.y)), square(hn::Sub(a.z, b.z))));
}
HWY_INLINE V exponential(V x) { return hn::Exp(D(), hn::Max(x, value(-80))); }

/// Integral of a lobe over the sphere, 2 pi (1 - e^(-2 s)) / s.
HWY_INLINE V integral(V sharpness) {
    const V s = hn::Max(sharpness, value(1e-5f));
    return hn::Div(hn::Mul(value(-2 * k_gloss_pi), hn::Expm1(D(), hn::Max(hn::Mul(value(-2), s), value(-80)))), s);
}

/// The sharpness of the lobe with mean cosine 1 - `spread` (Banerjee et al. 2005; within 4 %).
HWY_INLINE V sharpness_of(V spread) {
    const V d = hn::Max(spread, value(1e-12f)), r = hn::Sub(value(1), d);
    return hn::Div(hn::Mul(r, hn::Sub(value(3), square(r))), hn::Mul(d, hn::Sub(value(2), d)));
}

/// The views of one vector.
struct Seen {
    V sine, cosine, alpha2;
    const float* rows;
    std::size_t j;
    Seen(const float* r, std::size_t first) : rows(r), j(first) {
        sine = row(k_row_sine);
        cosine = row(k_row_cosine);
        alpha2 = row(k_row_alpha2);
    }
    [[nodiscard]] HWY_INLINE V row(std::size_t r) const { return hn::LoadU(D(), rows + r * k_block_size + j); }
    [[nodiscard]] HWY_INLINE Lanes3 viewer() const { return {sine, value(0), cosine}; }
    [[nodiscard]] HWY_INLINE Lanes3 mirror() const { return {hn::Neg(sine), value(0), cosine}; }
    /// A direction in the views' frames.
    [[nodiscard]] HWY_INLINE Lanes3 local(const Lanes3& w) const {
        const auto along = [&](std::size_t axis) HWY_ATTR {
            const std::size_t r = k_row_frame + 3 * axis;
            return hn::MulAdd(row(r), w.x, hn::MulAdd(row(r + 1), w.y, hn::Mul(row(r + 2), w.z)));
        };
        return {along(0), along(1), along(2)};
    }
};

/// A lobe's axis, and the sum of the directions to it and to the viewer, in the views' frames.
struct Towards {
    Lanes3 p, sum;
    /// The sum is rounded before it is turned: so it has its digits where the two are nearly opposite.
    HWY_INLINE Towards(const Seen& s, const Vec3& axis)
        : sum(s.local({hn::Add(s.row(k_row_viewer), value(axis.x)), hn::Add(s.row(k_row_viewer + 1), value(axis.y)),
                       hn::Add(s.row(k_row_viewer + 2), value(axis.z))})) {
        p = {hn::Sub(sum.x, s.sine), sum.y, hn::Sub(sum.z, s.cosine)};
    }
};

/// Half way between viewer and light; the normal where they are opposite.
HWY_INLINE Lanes3 half_vector(const Lanes3& sum) {
    const V size = hn::Sqrt(dot(sum, sum)), scale = inverse(hn::Max(size, value(1e-6f)));
    const auto opposite = hn::Le(size, value(1e-6f));
    return {hn::Mul(sum.x, scale), hn::Mul(sum.y, scale), hn::IfThenElse(opposite, value(1), hn::Mul(sum.z, scale))};
}

/// GGX of two squared widths at h.
HWY_INLINE V distribution(V along, V across, const Lanes3& h) {
    const V stretched = quadratic(inverse(along), inverse(across), value(1), h);
    return inverse(hn::Mul(hn::Mul(value(k_gloss_pi), hn::Sqrt(hn::Mul(along, across))), square(stretched)));
}

/// Smith's Lambda at squared cosine z2.
HWY_INLINE V smith(V alpha2, V z2) {
    const V tangent2 = hn::Div(hn::Sub(value(1), z2), z2);
    return hn::Mul(value(0.5f), hn::Sub(hn::Sqrt(hn::MulAdd(alpha2, tangent2, value(1))), value(1)));
}

struct Punctual {
    static HWY_INLINE V eval(const Seen& s, const Towards& to, const SgLight& light) {
        const V z2 = hn::Min(hn::Max(square(to.p.z), value(1e-12f)), value(1));
        const V hidden = hn::Add(s.row(k_row_masked), smith(s.alpha2, z2));
        const V kernel = hn::Div(distribution(s.alpha2, s.alpha2, half_vector(to.sum)),
                                 hn::Mul(hn::Mul(value(4), s.cosine), hidden));
        return hn::IfThenElseZero(hn::Gt(to.p.z, value(0)), hn::Mul(value(light.integral), kernel));
    }
};

/// The distribution as a Gaussian of sharpness 2 / alpha^2 about the normal, moved to light with its peak kept; all
/// else as in the mirror direction. Then a lobe times a lobe.
struct SgWarp {
    static HWY_INLINE V eval(const Seen& s, const Towards& to, const SgLight& light) {
        const V warped = inverse(hn::Mul(hn::Add(s.alpha2, s.alpha2), s.cosine)), lambda = value(light.sharpness);
        const Lanes3 mirror = s.mirror(), opposite{hn::Neg(mirror.x), hn::Neg(mirror.y), hn::Neg(mirror.z)};
        const V sum = hn::Add(warped, lambda), product = hn::Mul(warped, lambda);
        // |w m + l p|^2 = (w - l)^2 + w l |m + p|^2, which does not cancel.
        const V u = hn::Sqrt(hn::MulAdd(product, apart(opposite, to.p), square(hn::Sub(warped, lambda))));
        const V exponent = hn::Div(hn::Mul(product, apart(mirror, to.p)), hn::Add(u, sum));
        return hn::Mul(s.row(k_row_peak), hn::Mul(exponential(hn::Neg(exponent)), integral(u)));
    }
};

/// The same with two widths, across and along the plane of incidence: exp(-a x^2 - b y^2) about the mirror direction,
/// convolved with the light as exp(-nu |x|^2), nu = sharpness / 2.
struct AsgWarp {
    static HWY_INLINE V eval(const Seen& s, const Towards& to, const SgLight& light) {
        const V along = inverse(hn::Mul(value(4), s.alpha2)), across = hn::Div(along, square(s.cosine));
        const V nu = value(light.sharpness / 2), facing = hn::Max(dot(s.mirror(), to.p), value(0));
        const V y = hn::MulAdd(to.p.x, s.cosine, hn::Mul(to.p.z, s.sine));
        const V sum_along = hn::Add(nu, along), sum_across = hn::Add(nu, across);
        const V exponent = hn::Mul(
            nu, hn::MulAdd(hn::Div(across, sum_across), square(to.p.y), hn::Mul(hn::Div(along, sum_along), square(y))));
        const V width = hn::Mul(hn::Sqrt(sum_along), hn::Sqrt(sum_across));
        const V peak = hn::Mul(s.row(k_row_peak), value(k_gloss_pi));
        return hn::Mul(hn::Div(peak, width), hn::Mul(facing, exponential(hn::Neg(exponent))));
    }
};

/// erf for x >= 0, off by at most 1.5e-7 (Hastings 1955).
HWY_INLINE V erf_positive(V x) {
    const V t = inverse(hn::MulAdd(value(0.3275911f), x, value(1)));
    V fit = value(1.061405429f);
    for (float k : {-1.453152027f, 1.421413741f, -0.284496736f, 0.254829592f}) fit = hn::MulAdd(fit, t, value(k));
    return hn::NegMulAdd(hn::Mul(fit, t), exponential(hn::Neg(square(x))), value(1));
}

/// Share of a normalised lobe above the horizon, `cosine` its axis's z (Tokuyoshi 2022).
HWY_INLINE V share_above(V cosine, V sharpness) {
    const V s = hn::Max(sharpness, value(1e-2f));
    const V top = hn::MulAdd(value(0.5f), s, value(0.65173288f));
    const V t = hn::Mul(s, hn::Sqrt(hn::Div(top, hn::MulAdd(hn::Add(s, value(1.34182800f)), s, value(7.22166878f)))));
    const V ratio = hn::Div(erf_positive(hn::Mul(t, hn::Abs(cosine))), erf_positive(t));
    const V half = hn::Mul(value(0.5f), hn::CopySign(hn::Min(ratio, value(1)), cosine));
    const V below = exponential(hn::Neg(s));
    return hn::Div(hn::MulAdd(hn::Sub(value(1), below), hn::Add(value(0.5f), half), below), hn::Add(value(1), below));
}

/// GGX widened by a light, seen from the viewer: squared widths, along and across the plane of incidence, have grown by
/// the light's variance 1 / sharpness carried over to normals with the Jacobian at `cosine`. In projected space a
/// squared width q is f = q / (1 - q), where the two add up.
HWY_INLINE V widened(const Seen& s, const Lanes3& h, const SgLight& light, V cosine) {
    const V rest = hn::Sub(value(1), s.alpha2), variance = value(0.5f / light.sharpness);
    const auto wider = [&](V added) HWY_ATTR {
        const V more = hn::Mul(added, rest);
        return hn::Div(hn::Add(s.alpha2, more), hn::Add(value(1), more));
    };
    const V along = wider(variance), across = wider(hn::Div(variance, square(cosine)));
    const V projection = hn::Sqrt(hn::MulAdd(along, square(s.sine), square(s.cosine)));
    return hn::Div(distribution(along, across, h), hn::Mul(value(4), projection));
}

/// Light and reflection together, the latter as a broad Gaussian about the mirror direction: where their product lies.
struct ProductLobe {
    V cosine;  ///< of its axis to the normal
    V sharpness;
};
HWY_INLINE ProductLobe product_with_mirror(const Seen& s, const Lanes3& p, const SgLight& light) {
    const V broad = hn::Div(hn::Sub(value(1), s.alpha2), hn::Add(s.alpha2, s.alpha2)), lambda = value(light.sharpness);
    const Lanes3 u{hn::MulSub(lambda, p.x, hn::Mul(broad, s.sine)), hn::Mul(lambda, p.y),
                   hn::MulAdd(lambda, p.z, hn::Mul(broad, s.cosine))};
    const V size = hn::Sqrt(dot(u, u));
    return {hn::Div(u.z, hn::Max(size, value(1e-20f))), size};
}

struct Tokuyoshi2024 {
    static HWY_INLINE V eval(const Seen& s, const Towards& to, const SgLight& light) {
        const ProductLobe both = product_with_mirror(s, to.p, light);
        const V share = share_above(both.cosine, both.sharpness);
        return hn::Mul(hn::Mul(value(light.integral), share), widened(s, half_vector(to.sum), light, s.cosine));
    }
};

/// The reflection as the Gaussian of its albedo and its mean vector, convolved with the light so that mean cosines
/// multiply. For light of degree 1 in the direction, this is exact.
struct Moments {
    static HWY_INLINE V eval(const Seen& s, const Towards& to, const SgLight& light) {
        const Lanes3 axis{s.row(k_row_axis_x), value(0), s.row(k_row_axis_z)};
        const V sharpness = sharpness_of(hn::MulAdd(value(light.mean), s.row(k_row_spread), value(light.spread)));
        const V decay = exponential(hn::Mul(hn::Mul(value(-0.5f), sharpness), apart(axis, to.p)));
        return hn::Mul(hn::Mul(s.row(k_row_albedo), value(light.integral)), hn::Div(decay, integral(sharpness)));
    }
};

/// The widened GGX, seen and masked as the real one is; for a punctual light, this is exact.
struct Masked {
    static HWY_INLINE V eval(const Seen& s, const Towards& to, const SgLight& light) {
        const Lanes3 h = half_vector(to.sum);
        const V move = hn::Sub(dot(s.viewer(), h), s.cosine);
        const V cosine = hn::Max(hn::MulAdd(value(k_gloss_half), move, s.cosine), value(0.05f));

        // Mask light at the product's axis, lifted softly above the horizon.
        const ProductLobe both = product_with_mirror(s, to.p, light);
        const V softness = hn::Div(value(k_gloss_soft), hn::Add(both.sharpness, value(1)));
        const V lifted =
            hn::Mul(value(0.5f), hn::Add(both.cosine, hn::Sqrt(hn::MulAdd(both.cosine, both.cosine, softness))));
        const V z2 = hn::Min(hn::Max(square(lifted), value(1e-12f)), value(1));
        const V hidden = hn::Add(s.row(k_row_masked), smith(s.alpha2, z2));

        // Replace the visible area of the widened surface by that of the actual one.
        const V shown = hn::Sqrt(hn::MulAdd(s.alpha2, square(s.sine), square(s.cosine)));
        const V seen = hn::Div(shown, hn::Mul(s.cosine, hidden));
        const V share = share_above(both.cosine, both.sharpness);
        return hn::Mul(hn::Mul(value(light.integral), share), hn::Mul(widened(s, h, light, cosine), seen));
    }
};

struct TwoEnds {
    static HWY_INLINE V eval(const Seen& s, const Towards& to, const SgLight& light) {
        const V t = hn::Min(hn::Mul(value(light.power), s.row(k_row_middle)), value(1e9f));
        const V both = hn::MulAdd(t, Masked::eval(s, to, light), Moments::eval(s, to, light));
        return hn::Div(both, hn::Add(value(1), t));
    }
};

template <class Formula>
HWY_INLINE void reflect_all(const float* rows, std::span<const SgLight> lights, std::span<const Rgb> c,
                            MutableColourView out) {
    const D d;
    for (std::size_t j = 0; j < out.size; j += hn::Lanes(d)) {
        const Seen seen(rows, j);
        V r = hn::Zero(d), g = r, b = r;
        for (std::size_t i = 0; i < lights.size(); ++i) {
            const bool ambient = lights[i].sharpness < k_ambient_sharpness;
            const V e =
                ambient ? seen.row(k_row_albedo) : Formula::eval(seen, Towards(seen, lights[i].axis), lights[i]);
            r = hn::MulAdd(value(c[i].r), e, r);
            g = hn::MulAdd(value(c[i].g), e, g);
            b = hn::MulAdd(value(c[i].b), e, b);
        }
        store(d, r, out.channel(0), j, out.size);
        store(d, g, out.channel(1), j, out.size);
        store(d, b, out.channel(2), j, out.size);
    }
}

void ReflectLobes(SgSpecular kind, const float* rows, std::span<const SgLight> lights, std::span<const Rgb> c,
                  MutableColourView out) {
    switch (kind) {
        case SgSpecular::punctual:
            return reflect_all<Punctual>(rows, lights, c, out);
        case SgSpecular::sg_warp:
            return reflect_all<SgWarp>(rows, lights, c, out);
        case SgSpecular::asg_warp:
            return reflect_all<AsgWarp>(rows, lights, c, out);
        case SgSpecular::tokuyoshi_2024:
            return reflect_all<Tokuyoshi2024>(rows, lights, c, out);
        case SgSpecular::moments:
            return reflect_all<Moments>(rows, lights, c, out);
        case SgSpecular::masked:
            return reflect_all<Masked>(rows, lights, c, out);
        case SgSpecular::two_ends:
            return reflect_all<TwoEnds>(rows, lights, c, out);
    }
}

}  // namespace lobelia::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobelia {

HWY_EXPORT(ReflectLobes);

void reflect_lobes(SgSpecular kind, const float* rows, std::span<const SgLight> lights, std::span<const Rgb> c,
                   MutableColourView out) {
    HWY_DYNAMIC_DISPATCH(ReflectLobes)(kind, rows, lights, c, out);
}

}  // namespace lobelia
#endif
