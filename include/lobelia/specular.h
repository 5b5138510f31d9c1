// What a specular evaluator is: how coefficients are read as light that a glossy surface reflects to a viewer.
// Walter et al. 2007 (GGX); Heitz 2014 (masking and shadowing); Karis 2013 (the split sum).
#pragma once

#include "lobelia/basis.h"

namespace lobelia {

/// Where gloss is read: a unit normal, a unit direction to the viewer and GGX's alpha for each point, in the frame of
/// the basis. alpha is the square of glTF's roughness; below ggx::k_least_alpha it counts as that, above 1 as 1. A view
/// below the surface counts as a grazing one.
struct SpecularPoints {
    DirectionView normals, views;
    std::span<const float> alphas;
    [[nodiscard]] std::size_t size() const { return normals.size; }
};

/// Checks the arrays of an evaluation: the coefficients required, and a view, an alpha and a colour for each normal.
inline void check_specular(std::size_t required, std::span<const Rgb> c, const SpecularPoints& points,
                           const MutableColourView& out, SourcePlace place = SourcePlace::here()) {
    check_equal("coefficients", c.size(), required, place);
    check_equal("views for the normals", points.views.size, points.size(), place);
    check_equal("alphas for the normals", points.alphas.size(), points.size(), place);
    check_equal("colours for the normals", out.size, points.size(), place);
}

/// How coefficients are read as reflected radiance L(v) [W/(m^2 sr)], the integral over the hemisphere about n of
///
///   L(l) D(h) G(v, l) / (4 (n.v) (n.l)) (n.l),      h = (v + l) / |v + l|.
///
/// Included: the GGX distribution D, height-correlated Smith masking and shadowing G, the cosine of light. Left out:
/// the Fresnel factor, which is 1 (specular() puts it in); light between the facets; what the basis's own reader does
/// with negative radiance, but where an evaluator says so.
class SpecularEvaluator {
  public:
    virtual ~SpecularEvaluator() = default;
    [[nodiscard]] virtual std::string name() const = 0;
    [[nodiscard]] virtual Accuracy accuracy() const = 0;
    /// L(v) for a Fresnel factor of 1. out.size = points.size().
    virtual void reflected(std::span<const Rgb> c, const SpecularPoints& points, MutableColourView out) const = 0;
};

/// L(v) of a surface that reflects `f0` along its normal, by the split sum: reflected() times the share that Schlick's
/// Fresnel factor leaves of a constant light.
void specular(const SpecularEvaluator& evaluator, std::span<const Rgb> c, const SpecularPoints& points, Rgb f0,
              MutableColourView out);

/// Reads any basis: its radiance, clamped at 0, at `count` directions of visible normals (a Hammersley set, the same
/// for every point). It converges to the integral; broad lights and smooth surfaces need few directions.
[[nodiscard]] std::shared_ptr<const SpecularEvaluator> make_sampled_specular(std::shared_ptr<const Basis> basis,
                                                                             std::size_t count = 64);

}  // namespace lobelia
