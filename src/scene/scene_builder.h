// Makes scenes of gridded patches, each with its own chart, and packs the charts into one lightmap.
#pragma once

#include <concepts>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "lobelia/scene.h"

namespace lobelia {

/// A point of a patch; `normal` is unit, `uv` is for textures.
struct PatchPoint {
    Vec3 position;
    Vec3 normal;
    Vec2 uv;
};

struct PatchOptions {
    std::size_t columns = 1, rows = 1;  ///< quads
    Vec2 size{1, 1};                    ///< size of the chart, at most about that of the surface [m]
    float density = 1;                  ///< lightmap texels per metre, relative to other patches
    std::uint32_t material = 0;
    std::vector<float> column_stops = {}, row_stops = {};  ///< ascending, 0 to 1, one more than quads; empty: even
};

/// Faces of a box, combined by |.
enum Faces : unsigned {
    k_face_left = 1,
    k_face_right = 2,
    k_face_bottom = 4,
    k_face_top = 8,
    k_face_back = 16,
    k_face_front = 32,
    k_face_sides = k_face_left | k_face_right | k_face_back | k_face_front,
    k_face_all = 63
};

struct BoxOptions {
    unsigned faces = k_face_all;
    float density = 1;
    std::uint32_t material = 0;
    Transform world_from_box;
};

/// A point of a profile that is revolved about the y axis; the normal is unit, x away from the axis.
struct ProfilePoint {
    float radius = 0, y = 0;
    Vec2 normal{1, 0};
};

class SceneBuilder {
  public:
    explicit SceneBuilder(std::string name) { scene_.name = std::move(name); }

    [[nodiscard]] Scene& scene() { return scene_; }
    [[nodiscard]] std::uint32_t material(Material material);
    /// Begins a new object, in world space, for all surfaces added afterwards.
    void begin_object(std::string name);

    /// Adds a patch: evaluates surface(u, v) at each stop, from 0 to 1. Its front is where d/du x d/dv points.
    template <std::invocable<float, float> F>
    void patch(const PatchOptions& options, F&& surface) {
        add_grid(options, [&](std::size_t column, std::size_t row) {
            return surface(stop(options.column_stops, column, options.columns),
                           stop(options.row_stops, row, options.rows));
        });
    }

    /// Adds corner + u right + v up, with texture coordinates in metres from the corner; its front is where right x up
    /// points.
    void quad(Vec3 corner, Vec3 right, Vec3 up, const PatchOptions& options);
    /// Adds a box that faces outwards.
    void box(Vec3 lowest, Vec3 highest, const BoxOptions& options);
    /// Adds a profile, bottom to top, revolved about the vertical axis through `base`.
    void lathe(Vec3 base, std::span<const ProfilePoint> profile, std::size_t segments, const PatchOptions& options);

    struct LightmapOptions {
        std::uint32_t grid = 256;   ///< chart corners are multiples of 1 / grid
        std::uint32_t padding = 4;  ///< distance between charts [1 / grid]
    };
    /// Packs the charts at the largest scale that fits, and returns the scene. Removes texture coordinates of meshes
    /// without a texture. Leaves the builder empty.
    [[nodiscard]] Scene finish(const LightmapOptions& options);

  private:
    /// The vertices of a chart; its lightmap UVs lie in the unit square until it is placed.
    struct Chart {
        std::size_t mesh = 0, first_vertex = 0, vertices = 0;
        Vec2 size;
    };
    using GridPoint = std::function<PatchPoint(std::size_t column, std::size_t row)>;
    void add_grid(const PatchOptions& options, const GridPoint& point);
    [[nodiscard]] static float stop(std::span<const float> stops, std::size_t i, std::size_t count) {
        return stops.empty() ? static_cast<float>(i) / static_cast<float>(count) : stops[i];
    }

    Scene scene_;
    std::vector<Chart> charts_;
};

}  // namespace lobelia
