// Path-traced pictures from a camera.
#include "bake/render/render.h"

#include <cassert>
#include <cmath>

#include "bake/render/render_tiles.h"

namespace lobelia {
namespace {

class PathsWorker {
  public:
    PathsWorker(const PathTracer& tracer, const CameraView& view) : view_(&view), paths_(tracer) {}

    void shade(std::span<const PathStart> rays, std::span<const std::uint32_t> of_ray, RenderTile& tile) {
        sights_.resize(rays.size());
        view_->resolve(rays, sights_);
        paths_.add(sights_, of_ray, tile);
        for (std::size_t i = 0; i < sights_.size(); ++i)
            if (sights_[i].kind == Sight::Kind::unlit) tile.add(of_ray[i], view_->unlit_color(sights_[i].hit));
    }

  private:
    const CameraView* view_;
    PathShader paths_;
    std::vector<Sight> sights_;
};

}  // namespace

void PathShader::add(std::span<const Sight> sights, std::span<const std::uint32_t> of_ray, RenderTile& tile) {
    starts_.clear();
    of_start_.clear();
    for (std::size_t i = 0; i < sights.size(); ++i) {
        if (sights[i].kind != Sight::Kind::paths) continue;
        starts_.push_back(sights[i].start);
        of_start_.push_back(of_ray[i]);
    }
    incident_.resize(starts_.size());
    tracer_->trace(starts_, incident_, *scratch_);
    for (std::size_t i = 0; i < starts_.size(); ++i)
        tile.add(of_start_[i], incident_[i].emitted + incident_[i].scattered);
}

std::optional<Image> render_paths(const PathTracer& tracer, const Camera& camera, const RenderOptions& options) {
    assert(options.width > 0 && options.height > 0 && options.samples > 0);
    const CameraRays rays(camera, options.width, options.height, tracer.options().seed);
    const CameraView view(tracer, std::vector<std::uint8_t>(tracer.scene().objects.size()));
    return render_tiles(rays, options, [&] { return std::make_unique<PathsWorker>(tracer, view); });
}

Camera default_camera(const World& world) {
    // Look from the front, a little from the right and above, far enough to see a ball around the scene.
    Camera camera;
    const Vec3 back = normalize(Vec3{0.35f, 0.4f, 1}), right = normalize(cross({0, 1, 0}, back)),
               up = cross(back, right);
    const float radius = std::max(world.radius(), 1e-3f);
    const float distance = radius / std::sin(0.5f * camera.vertical_field_of_view);
    camera.name = "default";
    camera.world_from_camera = {{Vec3{right.x, up.x, back.x}, {right.y, up.y, back.y}, {right.z, up.z, back.z}},
                                (world.lowest + world.highest) * 0.5f + back * distance};
    return camera;
}

}  // namespace lobelia
