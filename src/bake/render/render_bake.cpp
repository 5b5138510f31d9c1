// A scene lit by its bake, from a camera.
#include <cassert>
#include <cmath>

#include "bake/place/texels.h"
#include "bake/render/render.h"
#include "bake/render/render_tiles.h"
#include "core/sample/directions.h"
#include "lobelia/evaluate.h"

namespace lobelia {
namespace {

/// Pairs of the Sobol sequences; pair 0 is the place within the pixel.
enum Dimension : std::uint32_t { k_base_direction = 1, k_layer_direction = 2 };

/// The four texels of a page around a point, and their bilinear weights.
struct Taps {
    const LightmapPage* page = nullptr;
    std::array<std::size_t, 4> texel;
    std::array<float, 4> weight;

    [[nodiscard]] float value(std::size_t plane) const {
        if (page == nullptr) return 0;
        const std::vector<float>& p = page->planes[plane];
        float sum = 0;
        for (std::size_t k = 0; k < 4; ++k) sum += weight[k] * p[texel[k]];
        return sum;
    }
};

/// Returns the taps at `p` [texels], clamped to the page.
Taps taps_at(const LightmapPage& page, Vec2 p) {
    const float right = static_cast<float>(page.width - 1), bottom = static_cast<float>(page.height - 1);
    const float x = std::clamp(p.x - 0.5f, 0.0f, right), y = std::clamp(p.y - 0.5f, 0.0f, bottom);
    const auto x0 = static_cast<std::size_t>(x), y0 = static_cast<std::size_t>(y);
    const std::size_t x1 = std::min(x0 + 1, page.width - 1), y1 = std::min(y0 + 1, page.height - 1);
    const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
    return {&page,
            {y0 * page.width + x0, y0 * page.width + x1, y1 * page.width + x0, y1 * page.width + x1},
            {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy}};
}

/// A visible point of a baked surface, and the terms of its shading.
struct BakedPoint {
    std::uint32_t of_ray = 0;
    Taps taps;              ///< without a page where probes light the surface
    Vec3 position, normal;  ///< unit normal, in the world
    Rgb emission;
    Rgb base;       ///< diffuse part of L over E / pi
    Rgb layer;      ///< specular part of L over the radiance from `mirrored`
    Vec3 mirrored;  ///< sampled direction, in the frame of the normal
};

class BakeWorker {
  public:
    BakeWorker(const PathTracer& tracer, const CameraView& view, const BakedLight& light)
        : tracer_(&tracer), view_(&view), light_(&light), paths_(tracer) {
        if (light.codec) block_.resize(3 * light.channels.coefficients * k_block_size);
    }

    void shade(std::span<const PathStart> rays, std::span<const std::uint32_t> of_ray, RenderTile& tile) {
        sights_.resize(rays.size());
        view_->resolve(rays, sights_);
        paths_.add(sights_, of_ray, tile);
        points_.clear();
        for (std::size_t i = 0; i < sights_.size(); ++i) {
            if (sights_[i].kind == Sight::Kind::unlit) tile.add(of_ray[i], view_->unlit_color(sights_[i].hit));
            if (sights_[i].kind == Sight::Kind::baked) points_.push_back(point(sights_[i], of_ray[i]));
        }
        if (!points_.empty()) add_points(tile);
    }

  private:
    [[nodiscard]] Taps taps(const PathTracer::Hit& hit) const;
    [[nodiscard]] BakedPoint point(const Sight& sight, std::uint32_t of_ray) const;
    void evaluate(MutableColourView irradiance, MutableColourView mirrored);
    void evaluate_probes(MutableColourView irradiance, MutableColourView mirrored);
    void add_points(RenderTile& tile);

    const PathTracer* tracer_;
    const CameraView* view_;
    const BakedLight* light_;
    PathShader paths_;
    std::vector<Sight> sights_;
    std::vector<BakedPoint> points_;
    std::vector<Rgb> coefficients_;  ///< of one point between probes
    std::vector<float> block_;       ///< coefficients of points_: a plane of k_block_size for each channel
};

Taps BakeWorker::taps(const PathTracer::Hit& hit) const {
    const World& world = tracer_->world();
    const auto& [a, b, c] = world.triangles[hit.triangle];
    const Vec2 uv =
        world.lightmap_uv[a] * (1 - hit.u - hit.v) + world.lightmap_uv[b] * hit.u + world.lightmap_uv[c] * hit.v;
    const AtlasPlacement& at = light_->placements[world.object[hit.triangle]];
    return taps_at(light_->pages[at.page], {at.scale.x * uv.x + at.offset.x, at.scale.y * uv.y + at.offset.y});
}

BakedPoint BakeWorker::point(const Sight& sight, std::uint32_t of_ray) const {
    const auto& [distance, triangle, u, v, back] = sight.hit;
    const SurfacePoint at = view_->surfaces().point(triangle, u, v, sight.start.direction);
    BakedPoint p;
    p.of_ray = of_ray;
    const std::uint32_t object = tracer_->world().object[triangle];
    if (light_->by_probes.empty() || light_->by_probes[object] == 0) p.taps = taps(sight.hit);
    p.position = at.origin;
    p.normal = at.normal;
    p.emission = view_->surfaces().emission(triangle, u, v);

    // Sample a direction for the base, whose albedo depends on what the layer transmits, and one for the layer.
    const Vec3 wo = Axes(tangent_from_world(at.normal)).local(sight.start.direction * -1.0f);
    const std::uint32_t seed = tracer_->options().seed;
    const auto random = [&](std::uint32_t number) { return pair(sight.start.key, sight.start.sample, number, seed); };
    p.base = base_albedo(at.reflectance, wo, cosine_direction(random(k_base_direction)));
    if (!at.reflectance.has_layer) return p;
    Reflectance layer = at.reflectance;
    layer.diffuse = {};
    const Scattered mirrored = scatter(layer, wo, random(k_layer_direction), 0);
    if (mirrored.pdf > 0) {
        p.layer = mirrored.weight;
        p.mirrored = mirrored.wi;
    }
    return p;
}

/// Evaluates the irradiance and the radiance from the mirrored direction at each point.
void BakeWorker::evaluate(MutableColourView irradiance, MutableColourView mirrored) {
    const std::size_t first = light_->channels.irradiance(0);
    if (!light_->codec) {
        for (std::size_t j = 0; j < points_.size(); ++j) {
            const Taps& t = points_[j].taps;
            const Rgb e{t.value(first), t.value(first + 1), t.value(first + 2)};
            set_entry(irradiance, j, e);
            set_entry(mirrored, j, e * k_over_pi);
        }
        return;
    }
    std::vector<const float*> c(3 * light_->channels.coefficients);
    for (std::size_t plane = 0; plane < c.size(); ++plane) {
        float* const to = block_.data() + plane * k_block_size;
        for (std::size_t j = 0; j < points_.size(); ++j) to[j] = points_[j].taps.value(plane);
        c[plane] = to;
    }
    Directions normals(points_.size()), directions(points_.size());
    for (std::size_t j = 0; j < points_.size(); ++j) {
        const BakedPoint& p = points_[j];
        const Vec3 wi = p.mirrored == Vec3{} ? Vec3{0, 0, 1} : p.mirrored;
        set_entry(normals.view(), j, light_->frame == Frame::tangent ? Vec3{0, 0, 1} : p.normal);
        set_entry(directions.view(), j,
                  light_->frame == Frame::tangent ? wi : Axes(tangent_from_world(p.normal)).world(wi));
    }
    lobelia::irradiance(light_->codec->evaluator(), c, normals, irradiance);
    radiance(light_->codec->basis(), c, directions, mirrored);
    if (light_->codec->evaluator().negative() == Negative::clamped) clamp_negative(mirrored);
}

/// The same for points that probes light.
void BakeWorker::evaluate_probes(MutableColourView irradiance, MutableColourView mirrored) {
    if (!light_->volume) return;
    const ProbeVolume& volume = *light_->volume;
    coefficients_.resize(volume.coefficients());
    for (std::size_t j = 0; j < points_.size(); ++j) {
        const BakedPoint& p = points_[j];
        if (p.taps.page != nullptr) continue;
        volume.coefficients(p.position, p.normal, coefficients_);
        set_entry(irradiance, j, volume.codec().irradiance(coefficients_, p.normal));
        if (p.mirrored == Vec3{}) continue;
        const Rgb L = volume.codec().radiance(coefficients_, Axes(tangent_from_world(p.normal)).world(p.mirrored));
        set_entry(mirrored, j, Rgb{std::max(0.0f, L.r), std::max(0.0f, L.g), std::max(0.0f, L.b)});
    }
}

void BakeWorker::add_points(RenderTile& tile) {
    Colours irradiance(points_.size()), mirrored(points_.size());
    evaluate(irradiance, mirrored);
    evaluate_probes(irradiance, mirrored);
    for (std::size_t j = 0; j < points_.size(); ++j) {
        const BakedPoint& p = points_[j];
        const Rgb diffuse = product(p.base, colour_at(irradiance.view(), j)) * k_over_pi;
        tile.add(p.of_ray, p.emission + diffuse + product(p.layer, colour_at(mirrored.view(), j)));
    }
}

}  // namespace

std::optional<Image> render_bake(const PathTracer& tracer, const BakedLight& light, const Camera& camera,
                                 const RenderOptions& options) {
    assert(options.width > 0 && options.height > 0 && options.samples > 0);
    assert(light.placements.size() == tracer.scene().objects.size());
    const CameraRays rays(camera, options.width, options.height, tracer.options().seed);
    std::vector<std::uint8_t> baked;
    for (std::size_t i = 0; i < light.placements.size(); ++i)
        baked.push_back(light.placements[i].baked || (!light.by_probes.empty() && light.by_probes[i] != 0) ? 1 : 0);
    const CameraView view(tracer, std::move(baked));
    static_assert(k_rays_at_once <= k_block_size);
    return render_tiles(rays, options, [&] { return std::make_unique<BakeWorker>(tracer, view, light); });
}

}  // namespace lobelia
