// Specular evaluators: light that a glossy surface reflects to a viewer, from coefficients.
// Walter et al. 2007 (GGX); Heitz 2014 (masking and shadowing); Karis 2013 (the split sum).
#pragma once

#include "lobelia/basis.h"

namespace lobelia {

/// Points at which specular reflection is evaluated: a unit normal, a unit direction to the viewer and GGX's alpha
/// each, in the frame of the basis. alpha is the square of glTF's roughness, clamped to [ggx::k_least_alpha, 1]. Views
/// below the surface count as grazing ones.
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

/// Evaluates coefficients as reflected radiance L(v) [W/(m^2 sr)], the integral over the hemisphere about n of
///
///   L(l) D(h) G(v, l) / (4 (n.v) (n.l)) (n.l),      h = (v + l) / |v + l|.
///
/// Included: the GGX distribution D, height-correlated Smith masking and shadowing G, the cosine of light. Not
/// included: the Fresnel factor, which is 1 (specular() applies it); multiple scattering between facets; the basis's
/// own treatment of negative radiance, unless an evaluator states it.
class SpecularEvaluator {
  public:
    virtual ~SpecularEvaluator() = default;
    [[nodiscard]] virtual std::string name() const = 0;
    [[nodiscard]] virtual Accuracy accuracy() const = 0;
    /// Computes L(v) for a Fresnel factor of 1. Precondition: out.size = points.size().
    virtual void reflected(std::span<const Rgb> c, const SpecularPoints& points, MutableColourView out) const = 0;
    /// Returns the shader code of reflected(): the body of
    ///
    ///   vec3 reflected(Coefficients light, GgxTexels texels, vec3 n, vec3 v, float alpha),
    ///
    /// of which the result is the name of a variable. `texels` are those of ggx_table() that the code's struct
    /// GgxTexels names. Errors: an evaluator that has none, with the reason.
    [[nodiscard]] virtual Result<ShaderCode> reflected_code() const {
        return Error{"specular evaluator " + name() + " has no shader code"};
    }
};

/// Computes L(v) of a surface with reflectance `f0` along its normal, by the split sum: reflected() times the fraction
/// of a constant light that Schlick's Fresnel factor reflects.
void specular(const SpecularEvaluator& evaluator, std::span<const Rgb> c, const SpecularPoints& points, Rgb f0,
              MutableColourView out);
/// Returns the shader code of specular(): as reflected_code(), with a last parameter vec3 f0. Errors: those of
/// reflected_code().
[[nodiscard]] Result<ShaderCode> specular_code(const SpecularEvaluator& evaluator);

/// A table of four channels for shaders: texel (x, y) of a layer is at 4 ((layer height + y) width + x).
struct SpecularTable {
    std::size_t width, height, layers;
    std::vector<float> texels;
};
/// Returns the table of reflection lobes, which shader code samples with linear filtering, clamped at its edges, at
/// ggx_coordinates(n.v, alpha). Values are within -1 to 2; half floats change albedo and Fresnel by at most 2.5e-4.
[[nodiscard]] SpecularTable ggx_table();

/// Makes an evaluator for any basis: it samples the radiance, clamped at 0, in `count` directions of visible normals (a
/// Hammersley set, the same for every point). Converges to the integral; broad lights and smooth surfaces need few
/// directions.
[[nodiscard]] std::shared_ptr<const SpecularEvaluator> make_sampled_specular(std::shared_ptr<const Basis> basis,
                                                                             std::size_t count = 64);

}  // namespace lobelia
