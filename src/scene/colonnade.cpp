// A small sunlit colonnade: an arcade before a gallery, three curtains, a garden of cypresses.
#include <algorithm>

#include "scene/colonnade_parts.h"
#include "scene/embedded.h"
#include "scene/sky_light.h"

namespace lobelia {

using namespace colonnade;

namespace {

void add_ground(SceneBuilder& builder, const Materials& m) {
    builder.begin_object("ground");
    builder.quad({-16, 0, 15}, {32, 0, 0}, {0, 0, -20}, surface(m.gravel, 0.3f));
    // Hide the horizon by a clipped hedge around the garden.
    builder.begin_object("hedge");
    constexpr float k_front = 14.2f, k_side = 15.2f;
    const auto hedge = [&](Vec3 low, Vec3 high, unsigned which) {
        builder.box(low, high, faces(which, m.leaves, 0.2f));
    };
    hedge({-16, 0, k_front}, {16, 2.4f, 15}, k_face_left | k_face_right | k_face_front | k_face_top);
    hedge({-k_side, 0, k_front}, {k_side, 2.4f, 15}, k_face_back);
    for (const float x : {-16.0f, k_side})
        hedge({x, 0, -5}, {x + 16 - k_side, 2.4f, k_front}, k_face_left | k_face_right | k_face_back | k_face_top);
    builder.begin_object("steps");
    builder.box({-k_end, 0, 0.95f}, {k_end, 0.15f, 1.3f},
                faces(k_face_top | k_face_front | k_face_left | k_face_right, m.stone));
    builder.box({-k_end, 0, k_edge}, {k_end, 0.3f, 0.95f}, faces(k_face_top | k_face_left | k_face_right, m.stone));
    builder.box({-k_end, 0.15f, k_edge}, {k_end, 0.3f, 0.95f}, faces(k_face_front, m.stone));
    builder.box({-k_end, 0, k_half_wall}, {k_end, k_floor, k_edge}, faces(k_face_left | k_face_right, m.stone));
    builder.box({-k_end, 0.3f, k_back}, {k_end, k_floor, k_edge}, faces(k_face_front, m.stone));
    builder.begin_object("floor");
    builder.quad({-k_end, k_floor, k_edge}, {2 * k_end, 0, 0}, {0, 0, k_back - k_edge}, surface(m.tiles));
    // Repeat the texture of four tiles every 2 m.
    for (Vec2& uv : builder.scene().meshes.back().uv[0]) uv = uv * 0.5f;
}

/// Adds the back and end walls: plaster above a painted dado inside, plain and coarse outside.
void add_walls(SceneBuilder& builder, const Materials& m) {
    constexpr float k_dado = k_floor + 1.1f, k_outside = 0.3f;
    constexpr float x = k_end, outer_x = k_end + k_thickness, outer_z = k_back - k_thickness;
    const auto inner_face = [&](Vec3 corner, Vec3 right, float top) {
        builder.quad(corner, right, {0, k_dado - corner.y, 0}, surface(m.dado));
        builder.quad({corner.x, k_dado, corner.z}, right, {0, top - k_dado, 0}, surface(m.plaster));
    };
    // Add end walls: behind the columns, beside each column between its slabs, and above it behind the arcade.
    const auto end_wall = [&](float at, float side) {
        const auto part = [&](float low, float high, auto&& add) {
            // Order the ends from left to right as seen from inside.
            const float begin = side < 0 ? high : low;
            add(Vec3{at, 0, begin}, Vec3{0, 0, side < 0 ? low - high : high - low});
        };
        part(k_back, -k_slab, [&](Vec3 corner, Vec3 right) {
            inner_face(corner + Vec3{0, k_floor, 0}, right, k_ceiling);
        });
        part(-k_slab, k_half_wall, [&](Vec3 corner, Vec3 right) {
            inner_face(corner + Vec3{0, k_floor + k_plinth_top, 0}, right, k_floor + k_abacus);
        });
        part(-k_slab, -k_half_wall, [&](Vec3 corner, Vec3 right) {
            constexpr float k_low = k_floor + k_abacus_top;
            builder.quad(corner + Vec3{0, k_low, 0}, right, {0, k_ceiling - k_low, 0}, surface(m.plaster));
        });
    };
    builder.begin_object("back wall");
    inner_face({-x, k_floor, k_back}, {2 * x, 0, 0}, k_ceiling);
    builder.box({-outer_x, 0, outer_z}, {outer_x, k_ceiling, k_back},
                faces(k_face_back | k_face_left | k_face_right, m.plaster, k_outside));
    // Add a ledge above the dado's edge, and a bench in front of it.
    builder.box({-x, k_dado - 0.02f, k_back}, {x, k_dado + 0.1f, k_back + 0.06f},
                faces(k_face_top | k_face_bottom | k_face_front, m.stone));
    builder.begin_object("bench");
    builder.box({-3, k_floor + 0.38f, k_back}, {3, k_floor + 0.46f, k_back + 0.5f},
                faces(k_face_all & ~unsigned{k_face_back}, m.stone));
    for (const float foot : {-2.6f, 0.0f, 2.6f})
        builder.box({foot - 0.12f, k_floor, k_back}, {foot + 0.12f, k_floor + 0.38f, k_back + 0.42f},
                    faces(k_face_left | k_face_right | k_face_front, m.stone));
    builder.begin_object("left wall");
    end_wall(-x, -1);
    builder.box({-outer_x, 0, k_back}, {-x, k_ceiling, k_half_wall},
                faces(k_face_left | k_face_front, m.plaster, k_outside));
    builder.begin_object("right wall");
    end_wall(x, 1);
    builder.box({x, 0, k_back}, {outer_x, k_ceiling, k_half_wall},
                faces(k_face_right | k_face_front, m.plaster, k_outside));
}

/// The wall above the columns: stops along x and the height of its lower edge at each, from left to right.
struct ArcadeEdge {
    std::vector<float> x, y;
};

ArcadeEdge arcade_edge() {
    ArcadeEdge edge{{-k_end}, {k_spring}};
    for (int bay = 0; bay < k_bays; ++bay) {
        const float centre = -k_half_length + (static_cast<float>(bay) + 0.5f) * k_bay;
        for (std::size_t i = 0; i <= k_arch_segments; ++i) {
            const double angle = k_pi * static_cast<double>(i) / k_arch_segments;
            edge.x.push_back(centre - k_arch_radius * static_cast<float>(std::cos(angle)));
            edge.y.push_back(k_spring + k_arch_radius * static_cast<float>(std::sin(angle)));
        }
    }
    edge.x.push_back(k_end);
    edge.y.push_back(k_spring);
    return edge;
}

void add_arcade(SceneBuilder& builder, const Materials& m) {
    // Add both faces of the wall, from the arches up to the ceiling; the back one runs from right to left.
    const ArcadeEdge edge = arcade_edge();
    builder.begin_object("arcade");
    PatchOptions face = surface(m.plaster);
    face.columns = edge.x.size() - 1;
    face.size = {2 * k_end, k_ceiling - k_spring};
    for (const bool front : {true, false}) {
        face.column_stops.clear();
        for (std::size_t i = 0; i < edge.x.size(); ++i)
            face.column_stops.push_back((front ? edge.x[i] : -edge.x[edge.x.size() - 1 - i]) / (2 * k_end) + 0.5f);
        face.column_stops.front() = 0;
        face.column_stops.back() = 1;
        std::size_t column = 0;
        builder.patch(face, [&](float u, float v) {
            const std::size_t i = front ? column : edge.x.size() - 1 - column;
            column = (column + 1) % edge.x.size();
            const float y = edge.y[i] + v * (k_ceiling - edge.y[i]);
            return PatchPoint{{edge.x[i], y, front ? k_half_wall : -k_half_wall},
                              {0, 0, front ? 1.0f : -1.0f},
                              {u * face.size.x, y - k_spring}};
        });
    }

    // Add the undersides of the arches.
    PatchOptions soffit = surface(m.stone);
    soffit.columns = k_arch_segments;
    soffit.size = {static_cast<float>(k_pi) * k_arch_radius, 2 * k_half_wall};
    for (int bay = 0; bay < k_bays; ++bay) {
        const float centre = -k_half_length + (static_cast<float>(bay) + 0.5f) * k_bay;
        builder.patch(soffit, [&](float u, float v) {
            const double angle = k_pi * static_cast<double>(u);
            const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
            return PatchPoint{{centre - k_arch_radius * c, k_spring + k_arch_radius * s, k_half_wall * (2 * v - 1)},
                              {c, -s, 0},
                              {u * soffit.size.x, v * soffit.size.y}};
        });
    }
}

void add_roof(SceneBuilder& builder, const Materials& m) {
    constexpr float x = k_end + k_thickness + 0.15f, front = k_half_wall + 0.2f, back = k_back - k_thickness - 0.15f;
    builder.begin_object("roof");
    // Add the ceiling inside, and the eaves around the walls.
    constexpr float wall_x = k_end + k_thickness, wall_back = k_back - k_thickness;
    for (const auto& [low, high] :
         {std::pair{Vec3{-k_end, 0, k_back}, Vec3{k_end, 0, -k_half_wall}},
          std::pair{Vec3{-x, 0, k_half_wall}, Vec3{x, 0, front}}, std::pair{Vec3{-x, 0, back}, Vec3{x, 0, wall_back}},
          std::pair{Vec3{-x, 0, wall_back}, Vec3{-wall_x, 0, k_half_wall}},
          std::pair{Vec3{wall_x, 0, wall_back}, Vec3{x, 0, k_half_wall}}})
        builder.quad({low.x, k_ceiling, low.z}, {high.x - low.x, 0, 0}, {0, 0, high.z - low.z},
                     surface(m.ceiling, 0.8f));
    builder.box({-x, k_ceiling, back}, {x, k_roof, front}, faces(k_face_top, m.roof, 0.2f));
    builder.box({-x, k_ceiling, back}, {x, k_roof, front}, faces(k_face_sides, m.stone, 0.6f));
    builder.begin_object("beams");
    for (int i = 0; i <= 2 * k_bays; ++i) {
        const float centre = -k_half_length + 0.5f * k_bay * static_cast<float>(i);
        builder.box({centre - 0.1f, k_ceiling - 0.24f, k_back}, {centre + 0.1f, k_ceiling, -k_half_wall},
                    faces(k_face_left | k_face_right | k_face_bottom, m.timber, 0.8f));
    }
}

/// Returns a camera at `eye` that looks at `target`.
Camera look(const char* name, Vec3 eye, Vec3 target, float vertical_field_of_view) {
    const Vec3 z = normalize(eye - target), x = normalize(cross({0, 1, 0}, z)), y = cross(z, x);
    Camera camera;
    camera.name = name;
    camera.world_from_camera = {{Vec3{x.x, y.x, z.x}, Vec3{x.y, y.y, z.y}, Vec3{x.z, y.z, z.z}}, eye};
    camera.vertical_field_of_view = vertical_field_of_view;
    return camera;
}

}  // namespace

Scene colonnade_scene(const ColonnadeOptions& options) {
    SceneBuilder builder("colonnade");
    const Materials m = add_materials(builder);
    add_ground(builder, m);
    add_walls(builder, m);
    add_arcade(builder, m);
    add_roof(builder, m);
    for (int i = 0; i <= k_bays; ++i) add_column(builder, m, -k_half_length + k_bay * static_cast<float>(i), i + 1);
    add_rods(builder, m);
    add_curtain(builder, {"red curtain", 0, -1.0f, 0.55f, 5, 0.3f, m.red});
    add_curtain(builder, {"blue curtain", 1, -1.0f, 0.1f, 4, 1.1f, m.blue});
    add_curtain(builder, {"ochre curtain", 2, -0.1f, 1.0f, 4, 2.3f, m.ochre});
    for (int i = 0; i < 4; ++i) add_pot(builder, m, {-4.5f + 3 * static_cast<float>(i), 0, 1.75f}, i + 1);
    constexpr std::array<Vec3, 6> k_trees{
        {{-10.5f, 0, 11}, {-5.8f, 0, 12}, {-1.2f, 0, 11.4f}, {3.4f, 0, 11.8f}, {-9.6f, 0, 1.5f}, {-10.4f, 0, -2.6f}}};
    for (std::size_t i = 0; i < k_trees.size(); ++i)
        add_cypress(builder, m, k_trees[i], 4.4f + 0.5f * static_cast<float>(i * 2 % 3), static_cast<int>(i + 1));
    Scene scene = builder.finish({.grid = 512, .padding = 4});
    SkyOptions sky;
    sky.sun_elevation = options.sun_elevation;
    sky.sun_azimuth = options.sun_azimuth;
    set_sky(scene, sky, options.sky_height);
    scene.cameras.push_back(look("gallery", {5.7f, 1.95f, -2.75f}, {-2.4f, 1.72f, -0.65f}, 0.9f));
    scene.cameras.push_back(look("garden", {7.8f, 2.3f, 9.2f}, {-1.6f, 2.3f, -0.5f}, 0.66f));
    return scene;
}

}  // namespace lobelia
