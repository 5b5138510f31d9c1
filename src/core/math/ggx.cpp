// GGX: distribution, masking, visible normals.
#include "core/math/ggx.h"

namespace lobelia::ggx {
namespace {

double lambda_of(double alpha, double sine_squared, double cosine) {
    return 0.5 * (std::sqrt(1 + alpha * alpha * sine_squared / (cosine * cosine)) - 1);
}

double sine_squared(Vec3 v) {
    return static_cast<double>(v.x) * static_cast<double>(v.x) + static_cast<double>(v.y) * static_cast<double>(v.y);
}

/// The viewer stretched to where the surface is the unit hemisphere, and the disc seen from there: the axes of its
/// plane (the second one half hidden) and how much of the second is hidden.
struct StretchedView {
    double x, z;     ///< the viewer; y is 0
    double visible;  ///< share of the hidden half's radius that is seen
    explicit StretchedView(const View& view) {
        const double sx = static_cast<double>(view.alpha) * static_cast<double>(view.sine);
        const double sz = static_cast<double>(view.cosine), scale = 1 / std::hypot(sx, sz);
        x = sx * scale;
        z = sz * scale;
        visible = 0.5 * (1 + z);
    }
};

/// The reflection of light, with the sum of the directions to viewer and light.
double reflection(const View& view, Vec3 light, Vec3 sum) {
    if (light.z <= 0) return 0;
    const Vec3 v = view.direction();
    const auto alpha = static_cast<double>(view.alpha);
    return distribution(alpha, normalize(sum)) /
           (4 * static_cast<double>(v.z) * (1 + smith(alpha, v) + smith(alpha, light)));
}

Vec3 unit_vector(double x, double y, double z) {
    const double scale = 1 / std::sqrt(x * x + y * y + z * z);
    return {static_cast<float>(x * scale), static_cast<float>(y * scale), static_cast<float>(z * scale)};
}

}  // namespace

View make_view(float cosine, float alpha) {
    View view;
    view.alpha = std::clamp(alpha, k_least_alpha, 1.0f);
    view.cosine = std::clamp(cosine, k_least_cosine, 1.0f);
    view.sine = std::sqrt(1 - view.cosine * view.cosine);
    view.viewer = view.direction();
    return view;
}

View make_view(Vec3 normal, Vec3 to_viewer, float alpha) {
    const float cosine = dot(normal, to_viewer);
    View view = make_view(cosine, alpha);
    view.z = normal;
    Vec3 along = to_viewer - normal * cosine;
    // Near the normal the length has all digits, 1 - cosine^2 few.
    if (cosine > k_least_cosine) view.sine = std::min(length(along), 1.0f);
    // A view along the normal has no side of its own: take any.
    if (dot(along, along) < 1e-12f)
        along = std::abs(normal.z) < 0.9f ? cross(normal, {0, 0, 1}) : cross(normal, {1, 0, 0});
    view.x = normalize(along);
    view.y = cross(view.z, view.x);
    view.viewer = cosine > k_least_cosine ? to_viewer : view.to_world(view.direction());
    return view;
}

double distribution(double alpha, Vec3 h) {
    const auto z = static_cast<double>(h.z);
    const double d = alpha * alpha * z * z + sine_squared(h);
    return alpha * alpha / (k_pi * d * d);
}

double smith(double alpha, Vec3 v) { return lambda_of(alpha, sine_squared(v), static_cast<double>(v.z)); }

double reflection(const View& view, Vec3 light) { return reflection(view, light, view.direction() + light); }

double reflection_from(const View& view, Vec3 w) {
    const Vec3 sum = view.to_local(view.viewer + w);
    return reflection(view, sum - view.direction(), sum);
}

Vec3 VisibleNormal::sample(const View& view, Point2 p) {
    const StretchedView s(view);
    const double r = std::sqrt(p.a), phi = 2 * k_pi * p.b;
    // Across the plane of incidence the disc is whole, along it one half is foreshortened.
    const double across = r * std::cos(phi), rim = std::sqrt(std::max(0.0, 1 - across * across));
    const double along = (1 - s.visible) * rim + s.visible * r * std::sin(phi);
    const double towards = std::sqrt(std::max(0.0, 1 - across * across - along * along));
    // Back from the disc, whose axes are y and the viewer's upright, and out of the stretched space.
    const auto alpha = static_cast<double>(view.alpha);
    const double x = -s.z * along + s.x * towards, z = s.x * along + s.z * towards;
    return unit_vector(alpha * x, alpha * across, std::max(1e-9, z));
}

double VisibleNormal::pdf(const View& view, Vec3 h) {
    const Vec3 v = view.direction();
    const auto alpha = static_cast<double>(view.alpha);
    const double facing = std::max(0.0, static_cast<double>(dot(v, h)));
    return h.z > 0 ? distribution(alpha, h) * facing / (static_cast<double>(v.z) * (1 + smith(alpha, v))) : 0;
}

Point2 VisibleNormal::inverse(const View& view, Vec3 h) {
    const StretchedView s(view);
    const auto alpha = static_cast<double>(view.alpha);
    const double hx = static_cast<double>(h.x) / alpha, hy = static_cast<double>(h.y) / alpha;
    const double hz = static_cast<double>(h.z), scale = 1 / std::sqrt(hx * hx + hy * hy + hz * hz);
    const double across = hy * scale, along = (-s.z * hx + s.x * hz) * scale;
    const double rim = std::sqrt(std::max(0.0, 1 - across * across));
    const double up = (along - (1 - s.visible) * rim) / s.visible;
    const double turns = std::atan2(up, across) / (2 * k_pi);
    return {std::min(across * across + up * up, 1 - 1e-12), turns < 0 ? turns + 1 : turns};
}

std::vector<Ray> rays(const View& view, std::size_t count) {
    std::vector<Ray> result;
    result.reserve(count);
    const Vec3 v = view.direction();
    const auto alpha = static_cast<double>(view.alpha);
    const double seen = 1 + smith(alpha, v), n = static_cast<double>(count);
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 h = VisibleNormal::sample(
            view, {(static_cast<double>(i) + 0.5) / n, radical_inverse_2(static_cast<std::uint32_t>(i))});
        const Vec3 l = h * (2 * dot(v, h)) - v;
        // The weight is the reflection over the density of l: what of the seen facets light reaches, too.
        if (l.z > 0) result.push_back({l, static_cast<float>(seen / (n * (seen + smith(alpha, l))))});
    }
    return result;
}

}  // namespace lobelia::ggx
