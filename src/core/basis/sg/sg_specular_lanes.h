// The vectorised half of glossy reflection: constants of a lobe, rows of constants of views, the formulae of the two.
#pragma once

#include "core/basis/sg/sg_specular.h"

namespace lobelia {

/// The fitted numbers of SgSpecular::two_ends: it passes from one end to the other at sharpness k_gloss_middle times
/// that of the reflection times (n.v)^k_gloss_grazing, with steepness k_gloss_steepness; how soft the horizon is to
/// masking; how far the half vector moves from the normal to its own place where the light's width is carried over to
/// normals. Fitted together by least mean error at alpha .07 to .95, n.v .15 to .99, sharpness 1 to 100, at none of the
/// points of the published table.
inline constexpr float k_gloss_middle = 2.22f, k_gloss_grazing = 0.37f, k_gloss_steepness = 1.775f;
inline constexpr float k_gloss_soft = 1.22f, k_gloss_half = 0.707f;

/// Lobes below this sharpness are ambient light, which the albedo reflects.
inline constexpr float k_ambient_sharpness = 1e-8f;

/// A lobe, and its parameters for the formulae.
struct SgLight {
    Vec3 axis;
    float sharpness, integral;
    float mean, spread;  ///< mean cosine, and 1 - it with all digits
    float power;         ///< sharpness^k_gloss_steepness
};

/// Rows of a block of views; row r of view j is at r * k_block_size + j. The frame first, x, y and z by components.
enum SgViewRow : std::size_t {
    k_row_frame = 0,
    k_row_viewer = 9,  ///< the direction to the viewer, three rows
    k_row_sine = 12,
    k_row_cosine,
    k_row_alpha2,
    k_row_peak,    ///< the reflection in the mirror direction
    k_row_masked,  ///< 1 + Smith's Lambda of the viewer
    k_row_middle,  ///< (the sharpness where the ends meet) ^ -k_gloss_steepness
    k_row_axis_x,  ///< mean direction of the reflection, y = 0
    k_row_axis_z,
    k_row_spread,
    k_row_albedo,
    k_view_rows
};

/// out_j = sum of c_i times what view j reflects of light i. At most k_block_size views.
void reflect_lobes(SgSpecular kind, const float* rows, std::span<const SgLight> lights, std::span<const Rgb> c,
                   MutableColourView out);

}  // namespace lobelia
