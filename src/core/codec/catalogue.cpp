// THE lists: families of bases and encoders, with a card for each. Every codec follows from them.
#include "core/codec/catalogue.h"

#include <array>

#include "core/basis/ahd.h"
#include "core/basis/ambient_cube_irradiance.h"
#include "core/basis/ambient_dice.h"
#include "core/basis/cosine_lobes.h"
#include "core/basis/directional_lightmaps.h"
#include "core/basis/hemisphere_polynomials.h"
#include "core/basis/octahedral.h"
#include "core/basis/sg/fitted_gaussians.h"
#include "core/basis/sg/spherical_gaussians.h"
#include "core/basis/sh/spherical_harmonics.h"
#include "core/basis/sh/zh3.h"
#include "lobelia/encoders.h"

namespace lobelia {
namespace {

using LinearPtr = std::shared_ptr<const LinearBasis>;
using EncoderPtr = std::shared_ptr<const Encoder>;

constexpr std::array k_gaussian_patterns = {
    NamePattern{"sg<N>, sg<N>a", "N spherical Gaussians on the sphere, 1 to 512; a: and an ambient lobe"},
    NamePattern{"sg<N>h", "N on the hemisphere"},
    NamePattern{"sg<N>@S", "any of these with sharpness S, 0.01 to 10000, instead of their own"},
    NamePattern{"sg{X Y Z S;...}, sgh{...}", "given lobes: axis and sharpness, or \"ambient\", each"},
};
constexpr std::array k_fitted_patterns = {
    NamePattern{"sgfit<N>", "N spherical Gaussians with fitted axes and sharpness, 1 to 12"}};
constexpr std::array k_octahedral_patterns = {NamePattern{"oct<N>", "N x N octahedral texels, N even, 2 to 64"}};

/// The families, in the order in which lists show them. BasisCard explains the fields of a card.
constexpr std::array k_bases = {
    BasisEntry{
        "sg12 sg12h",
        SphericalGaussians::from_name,
        {.family = "Spherical Gaussians",
         .formula = "L(w) = sum of c_i exp(lambda_i (w . p_i - 1)), on fixed axes p_i with fixed sharpness lambda_i",
         .good_at = "radiance that stays positive (with a non-negative encoder); specular reflection, since a lobe "
                    "times a lobe is a lobe; as many lobes as the budget allows",
         .bad_at = "irradiance by plain least squares (the joint norm corrects it); rotation, as the axes are fixed",
         .furnace_bias = 0.04},
        k_gaussian_patterns},
    BasisEntry{
        "sh1 sh2 sh3 sh4 sh5 sh6 sh7 sh8",
        SphericalHarmonics::from_name,
        {.family = "Spherical harmonics",
         .formula = "L(w) = sum over l and m of c_lm Y_lm(w), orthonormal and real, all signs plus, index l^2 + l + m",
         .good_at = "smooth light and its irradiance (degree 2 is off by a few per cent); rotation; adding and "
                    "filtering, since they are linear and have no axis of their own",
         .bad_at = "small and bright sources: they ring, radiance and irradiance become negative opposite to the sun"}},
    BasisEntry{"zh3",
               Zh3::from_name,
               {.family = "ZH3",
                .formula = "L(w) = degree-1 harmonics + z Y_20(axis . w), the axis that of degree 1",
                .good_at = "irradiance nearly as good as degree 2 for 15 floats in place of 27",
                .bad_at = "light from two sides, which has no axis; filtering, where neighbours' axes differ"}},
    BasisEntry{"zh3-rgb",
               Zh3::from_name,
               {.family = "ZH3, an axis for each channel",
                .formula = "L(w) = degree-1 harmonics + z Y_20(axis . w), the axis that of degree 1",
                .good_at = "irradiance nearly as good as degree 2 for 15 floats in place of 27",
                .bad_at = "light from two sides, which has no axis; filtering, where neighbours' axes differ"}},
    BasisEntry{"ambient-cube",
               CosineLobes::from_name,
               {.family = "Ambient cube",
                .formula = "L(w) = sum of C_i max(0, w . p_i)^2",
                .good_at = "characters lit by probes in six colours; a normal needs no more than three of them",
                .bad_at = "anything sharper than a gradient; directions between the axes"}},
    BasisEntry{
        "ambient-cube-e",
        AmbientCubeIrradiance::from_name,
        {.family = "Ambient cube of irradiances",
         .formula = "E(n) = sum of n_i^2 C_i over the three sides that n faces; L(w) is taken as E(w) / pi",
         .good_at = "characters lit by probes: six colours, three of them for a normal, never negative",
         .bad_at =
             "irradiance between the axes; the radiance cube with its exact irradiance is better for the same floats"}},
    BasisEntry{
        "dice-srbf",
        CosineLobes::from_name,
        {.family = "Ambient dice, radial functions",
         .formula = "L(w) = sum of C_i (.35 c_i^2 + .25 c_i^4), c_i = max(0, w . p_i)",
         .good_at =
             "irradiance in 36 floats: smoother than lobes, no axis is preferred; a normal needs six of the twelve",
         .bad_at = "radiance of small sources; coefficients are large and of both signs"}},
    BasisEntry{"dice-bezier",
               AmbientDice::from_name,
               {.family = "Ambient dice, Bezier patches",
                .formula = "L(w) = a cubic on each face of an icosahedron through the values and slopes at its three "
                           "vertices, smooth across edges; of 108 floats a direction needs 27",
                .good_at = "radiance and irradiance of much detail for the floats that a lookup touches",
                .bad_at = "memory; rotation needs resampling of the whole",
                .encoders = "moments least-squares regularised"}},
    BasisEntry{"dice-ycocg",
               AmbientDice::from_name,
               {.family = "Ambient dice, luminance and chroma",
                .formula = "Y as in dice-bezier, Co and Cg linear on each face; of 60 floats a direction needs 15",
                .good_at = "as dice-bezier, for light of one or two colours",
                .bad_at = "small coloured sources, whose colour spreads over a face"}},
    BasisEntry{
        "ahd",
        AmbientHighlight::from_name,
        {.family = "Ambient and highlight direction",
         .formula = "E(n) = pi A + H max(0, n . d); as radiance, A + 9/2pi H max(0, w . d)^8",
         .good_at =
             "one dominant light; highlights of glossy surfaces, for which it has a direction and a colour; 9 floats",
         .bad_at = "two lights; soft light from one side; filtering, where neighbours' directions differ"}},
    // The octahedral texels that lobes are fitted from need no Gram matrix.
    BasisEntry{
        "sgfit3 sgfit4 sgfit6",
        FittedGaussians::from_name,
        {.family = "Fitted spherical Gaussians",
         .formula =
             "L(w) = sum of a_j exp(v_j . w - |v_j|), a_j >= 0, v_j the axis times the sharpness; 6 floats a lobe",
         .good_at = "radiance of a few sources, however sharp, far below other bases at equal floats; never negative",
         .bad_at = "baking many texels (a search for each); filtering, where neighbours' lobes differ",
         .encoders = "moments"},
        k_fitted_patterns},
    // Cells do not overlap: the running average is least squares, and others are no better.
    BasisEntry{
        "oct8 oct16",
        OctahedralTexels::from_name,
        {.family = "Octahedral texels",
         .formula = "L(w) = c_i of the cell that holds w: w / (|x| + |y| + |z|), its lower half folded out, on a grid "
                    "of N x N",
         .good_at = "any radiance, at any resolution that the budget allows; adding a sample touches one cell",
         .bad_at = "bytes; noise, since few samples fall into each cell",
         .encoders = "running-average moments"},
        k_octahedral_patterns},
    BasisEntry{"hl2",
               CosineLobes::from_name,
               {.family = "Radiosity normal mapping",
                .formula = "L(w) = sum of C_i max(0, w . p_i)^2",
                .good_at = "normal-mapped lightmaps in three colours, each a lightmap of its own",
                .bad_at = "light along the normal, which no direction faces; `squares` underestimates a constant sky",
                .furnace_bias = 0.06}},
    // No joint norm: it takes functions whole, but these have no meaning below the horizon.
    BasisEntry{"h4 h6",
               HemispherePolynomials::from_name,
               {.family = "H-basis",
                .formula = "L(w) = sum of c_i H_i(w), H = sqrt(1/2pi), sqrt(3/2pi) y, sqrt(3/2pi) (2z - 1), "
                           "sqrt(3/2pi) x, and for six sqrt(15/2pi) xy, sqrt(15/8pi) (x^2 - y^2)",
                .good_at = "lightmaps with normal maps: no coefficient is spent below the horizon, and irradiance at "
                           "the surface's own normal is exact after least squares",
                .bad_at = "small and bright sources; use where a normal may point below the surface",
                .encoders = "projection progressive moments least-squares regularised matrix-gain"}},
    BasisEntry{"sh1h",
               DirectionalLightmap::from_name,
               {.family = "Degree-1 harmonics of the hemisphere",
                .formula = "L(w) = sum of c_i Y_i(w), degree 1, c_i = integral of L Y_i above the surface",
                .good_at = "bakes that only sum samples: E(n) = integral of L / 4 + (integral of L w) . n / 2",
                .bad_at = "light from the side: degree 1 is too smooth for a horizon"}},
    BasisEntry{
        "irradz",
        DirectionalLightmap::from_name,
        {.family = "Degree-1 harmonics, exact at the normal",
         .formula = "E(n) = e0 + e . n, E exact at the surface's normal, nearest by least squares at the others above",
         .good_at =
             "lightmaps under normal maps in 12 floats, evaluated like degree-1 harmonics: flat surfaces are exact",
         .bad_at = "radiance, which only represents the irradiance"}},
    BasisEntry{"enlighten",
               DirectionalLightmap::from_name,
               {.family = "Directional lightmap",
                .formula = "E(n) = E (1 + n . D) / (1 + D_z), E a colour, D a vector of at most length 1",
                .good_at = "six floats; a flat surface has exactly the lightmap that it would have without directions",
                .bad_at = "lights of different colours from different sides; light at grazing angles"}},
    BasisEntry{"enlighten-rgb",
               DirectionalLightmap::from_name,
               {.family = "Directional lightmap, a direction for each channel",
                .formula = "E(n) = E (1 + n . D) / (1 + D_z), E and D for each channel",
                .good_at = "as above, with coloured light from several sides",
                .bad_at = "twelve floats, as many as degree-1 harmonics, which are cheaper to evaluate"}},
};

template <MomentSolver solver>
EncoderPtr moments(LinearPtr basis) {
    return make_moment_encoder(std::move(basis), solver);
}
template <Sign sign>
EncoderPtr progressive(LinearPtr basis) {
    return make_progressive(std::move(basis), sign);
}
template <ProgressiveOptions::Denominator denominator>
EncoderPtr progressive_with(LinearPtr basis) {
    return make_progressive(std::move(basis), Sign::any, {.denominator = denominator});
}
EncoderPtr progressive_ramped(LinearPtr basis) { return make_progressive(std::move(basis), Sign::any, {.ramp = 64}); }
EncoderPtr progressive_accelerated(LinearPtr basis) {
    return make_progressive(std::move(basis), Sign::any, {.acceleration = 3});
}
template <Sign sign>
EncoderPtr running_average(LinearPtr basis) {
    return make_running_average(std::move(basis), sign);
}

/// The encoders, in the order in which lists show them.
constexpr std::array k_encoders = {
    EncoderEntry{"projection", Needs::any_basis, "least-squares", moments<MomentSolver::projection>},
    EncoderEntry{"running-average", Needs::non_negative_basis, "least-squares", running_average<Sign::any>},
    EncoderEntry{"running-average-nn", Needs::non_negative_basis, "nnls", running_average<Sign::non_negative>},
    EncoderEntry{"progressive", Needs::any_basis, "least-squares", progressive<Sign::any>},
    EncoderEntry{"progressive-nn", Needs::non_negative_basis, "nnls", progressive<Sign::non_negative>},
    EncoderEntry{"moments", Needs::any_basis, "least-squares", moments<MomentSolver::analytic_gram>},
    EncoderEntry{"least-squares", Needs::any_basis, "least-squares", moments<MomentSolver::sampled_gram>},
    EncoderEntry{"regularised", Needs::any_basis, "least-squares", moments<MomentSolver::regularised>},
    EncoderEntry{"matrix-gain", Needs::any_basis, "least-squares", make_matrix_gain},
    EncoderEntry{"nnls", Needs::non_negative_basis, "nnls", moments<MomentSolver::non_negative>},
    EncoderEntry{"joint", Needs::any_basis, "joint", moments<MomentSolver::joint>},
    EncoderEntry{"joint-nn", Needs::non_negative_basis, "joint-nn", moments<MomentSolver::joint_non_negative>},
    EncoderEntry{"progressive-sampled", Needs::any_basis, "least-squares",
                 progressive_with<ProgressiveOptions::Denominator::sampled>, Listed::no},
    EncoderEntry{"progressive-exact", Needs::any_basis, "least-squares",
                 progressive_with<ProgressiveOptions::Denominator::exact>, Listed::no},
    EncoderEntry{"progressive-ramped", Needs::any_basis, "least-squares", progressive_ramped, Listed::no},
    EncoderEntry{"progressive-accelerated", Needs::any_basis, "least-squares", progressive_accelerated, Listed::no},
};

}  // namespace

std::span<const BasisEntry> basis_entries() { return k_bases; }
std::span<const EncoderEntry> encoder_entries() { return k_encoders; }

std::string default_codec() { return "sh2/moments/convolution"; }

}  // namespace lobelia
