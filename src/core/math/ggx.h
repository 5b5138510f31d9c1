// The GGX reflection as mathematics: distribution, masking, visible normals, and a table of what a whole lobe does.
// Walter et al. 2007; Heitz 2014 (height-correlated masking); Heitz 2018 (visible normals); Schlick 1994; Karis 2013.
#pragma once

#include <array>
#include <vector>

#include "lobelia/sampling.h"

namespace lobelia::ggx {

/// Smoother surfaces and more grazing views count as these.
inline constexpr float k_least_alpha = 5e-3f, k_least_cosine = 5e-3f;

/// A surface as the viewer sees it. The frame: z is the normal, x the viewer's side of the tangent plane; the direction
/// to the viewer is (sine, 0, cosine).
struct View {
    Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    Vec3 viewer{0, 0, 1};        ///< the direction to the viewer, in the frame that x, y and z are given in
    float sine = 0, cosine = 1;  ///< of the angle between normal and viewer
    float alpha = 1;
    [[nodiscard]] Vec3 to_local(Vec3 w) const { return {dot(x, w), dot(y, w), dot(z, w)}; }
    [[nodiscard]] Vec3 to_world(Vec3 w) const { return x * w.x + y * w.y + z * w.z; }
    [[nodiscard]] Vec3 direction() const { return {sine, 0, cosine}; }
};
/// alpha and the angle are cut to what the model knows.
[[nodiscard]] View make_view(Vec3 normal, Vec3 view, float alpha);
/// The view in its own frame, `cosine` to the normal.
[[nodiscard]] View make_view(float cosine, float alpha);

/// D(h) [1/sr], h in the local frame, h.z >= 0.
[[nodiscard]] double distribution(double alpha, Vec3 h);
/// Smith's Lambda of a direction with v.z > 0.
[[nodiscard]] double smith(double alpha, Vec3 v);
/// D G / (4 n.v) [1/sr]: the reflectance distribution times n.l, without Fresnel; 0 for light below the surface.
[[nodiscard]] double reflection(const View& view, Vec3 light);

/// The same for light from `w` in the frame that view.x, y and z are given in. Has more digits where the viewer and
/// light are nearly opposite: their sum is rounded before it is turned.
[[nodiscard]] double reflection_from(const View& view, Vec3 w);

/// Normals as the viewer sees them, h [local frame], with density D (v.h) / (n.v (1 + Lambda(v))) [1/sr].
struct VisibleNormal {
    [[nodiscard]] static Vec3 sample(const View& view, Point2 p);
    [[nodiscard]] static double pdf(const View& view, Vec3 h);
    [[nodiscard]] static Point2 inverse(const View& view, Vec3 h);
};

/// A direction to light and what it counts for: reflected radiance is the sum of weight times L(direction).
struct Ray {
    Vec3 direction;  ///< in the local frame, z > 0
    float weight = 0;
};
/// The reflection of `count` visible normals, a Hammersley set; those that end below the surface are left out. The
/// error for smooth light falls as 1 / count, nearly.
[[nodiscard]] std::vector<Ray> rays(const View& view, std::size_t count);

/// The highest degree of Lobe::zonal.
inline constexpr std::size_t k_zonal_degree = 8;

/// Integrals of the reflection, for a Fresnel factor of 1 unless stated otherwise.
struct Lobe {
    float albedo = 1;                               ///< integral of reflection() over light
    float fresnel = 0;                              ///< the same with Schlick's power (1 - v.h)^5
    Vec3 axis{0, 0, 1};                             ///< mean direction of light, local frame
    float spread = 0;                               ///< 1 - the length of the mean direction vector
    std::array<float, k_zonal_degree + 1> zonal{};  ///< mean of P_l(axis . light), l = 0 ..: 1, 1 - spread, ...
};
/// Returns the lobe from a table in alpha and n.v, computed at the first call (0.1 s). Largest errors for alpha and n.v
/// from 0.1 on: albedo 0.0015, fresnel 0.001, axis 0.006 of the root of the spread, spread 1 %, zonal 0.004. Below:
/// 0.015, 0.02, 0.12, 50 %, 0.014. Tested.
[[nodiscard]] Lobe lobe(const View& view);

/// Texels along either side of the table, and its layers of four channels: albedo, fresnel, the sine of the axis's
/// angle from the mirror direction, root of the spread / alpha; zonal 2 to 5; zonal 6 to 8 and 0.
inline constexpr std::size_t k_table_side = 32, k_table_layers = 3;
/// Returns the table, channels of texels of rows of layers. Columns go by the view, rows by alpha.
[[nodiscard]] std::vector<float> table_texels();
/// The same by `count` rays, without the table.
[[nodiscard]] Lobe lobe_by_rays(const View& view, std::size_t count);

}  // namespace lobelia::ggx
