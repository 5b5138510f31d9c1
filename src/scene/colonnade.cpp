// A small sunlit colonnade: an arcade before a gallery, three curtains, a garden of cypresses.
#include <algorithm>
#include <numbers>

#include "lobelia/colour.h"
#include "scene/embedded.h"
#include "scene/scene_builder.h"
#include "scene/sky_light.h"

namespace lobelia {
namespace {

// Measures [m]. The arcade stands on z = 0 and looks to +z; the gallery is behind it.
constexpr int k_bays = 4;
constexpr float k_bay = 3, k_half_length = 0.5f * k_bays * k_bay;
constexpr float k_floor = 0.45f;  // three steps
constexpr float k_spring = k_floor + 2.8f, k_arch_radius = 1.15f;
constexpr float k_ceiling = k_floor + 4.45f, k_roof = k_ceiling + 0.4f;
constexpr float k_half_wall = 0.25f;            // of the arcade's thickness
constexpr float k_end = k_half_length + 0.35f;  // inner face of the end walls
constexpr float k_back = -3.6f;                 // inner face of the back wall
constexpr float k_thickness = 0.3f;             // of back and end walls
constexpr float k_edge = 0.6f;                  // where the floor ends and the steps begin
constexpr std::size_t k_arch_segments = 16, k_column_segments = 16;

struct Materials {
    std::uint32_t stone, plaster, dado, ceiling, timber, tiles, gravel, roof, red, blue, ochre, bronze, terracotta,
        leaves;
};

/// Squares of two kinds of stone with slightly different shades and dark joints; linear colours.
Texture tile_texture() {
    constexpr std::size_t k_tiles = 4, k_texels = 32, k_side = k_tiles * k_texels;
    constexpr std::array<Rgb, 2> k_stones{Rgb{0.62f, 0.53f, 0.42f}, Rgb{0.33f, 0.15f, 0.09f}};
    Texture texture;
    texture.name = "tiles";
    texture.width = texture.height = k_side;
    texture.texels.reserve(k_side * k_side);
    for (std::size_t y = 0; y < k_side; ++y)
        for (std::size_t x = 0; x < k_side; ++x) {
            const std::size_t tx = x / k_texels, ty = y / k_texels;
            const bool joint = x % k_texels == 0 || y % k_texels == 0;
            const float shade = 0.86f + 0.04f * static_cast<float>((7 * tx + 5 * ty + 3 * tx * ty) % 8);
            const Rgb color = joint ? Rgb{0.16f, 0.12f, 0.09f} : k_stones[(tx + ty) % 2] * shade;
            const auto byte = [](float linear) {
                return static_cast<std::uint8_t>(std::lround(255 * srgb_from_linear(static_cast<double>(linear))));
            };
            texture.texels.push_back({byte(color.r), byte(color.g), byte(color.b), 255});
        }
    return texture;
}

Materials add_materials(SceneBuilder& builder) {
    const auto plain = [&](const char* name, Rgb color, float roughness = 0.9f) {
        Material material;
        material.name = name;
        material.base_color = color;
        material.roughness = roughness;
        return material;
    };
    const auto cloth = [&](const char* name, Rgb color) {
        Material material = plain(name, color, 1);
        material.double_sided = true;
        material.specular = 0;
        return material;
    };
    builder.scene().textures.push_back(tile_texture());
    Material tiles = plain("tiles", {1, 1, 1}, 0.45f);
    tiles.base_color_texture = TextureUse{};
    Material bronze = plain("bronze", {0.55f, 0.34f, 0.14f}, 0.35f);
    bronze.metallic = 1;
    return {builder.material(plain("stone", {0.66f, 0.58f, 0.46f})),
            builder.material(plain("plaster", {0.74f, 0.66f, 0.54f})),
            builder.material(plain("dado", {0.42f, 0.12f, 0.07f})),
            builder.material(plain("ceiling", {0.70f, 0.64f, 0.55f})),
            builder.material(plain("timber", {0.20f, 0.11f, 0.06f})),
            builder.material(tiles),
            builder.material(plain("gravel", {0.30f, 0.25f, 0.18f}, 1)),
            builder.material(plain("roof", {0.45f, 0.20f, 0.12f})),
            builder.material(cloth("red cloth", {0.58f, 0.045f, 0.03f})),
            builder.material(cloth("blue cloth", {0.04f, 0.12f, 0.46f})),
            builder.material(cloth("ochre cloth", {0.72f, 0.36f, 0.05f})),
            builder.material(bronze),
            builder.material(plain("terracotta", {0.52f, 0.20f, 0.10f})),
            builder.material(plain("leaves", {0.07f, 0.14f, 0.035f}))};
}

BoxOptions faces(unsigned which, std::uint32_t material, float density = 1) {
    BoxOptions options;
    options.faces = which;
    options.material = material;
    options.density = density;
    return options;
}

PatchOptions surface(std::uint32_t material, float density = 1) {
    PatchOptions options;
    options.material = material;
    options.density = density;
    return options;
}

void add_ground(SceneBuilder& builder, const Materials& m) {
    builder.begin_object("ground");
    builder.quad({-16, 0, 15}, {32, 0, 0}, {0, 0, -20}, surface(m.gravel, 0.3f));
    builder.begin_object("steps");
    builder.box({-k_end, 0, 0.95f}, {k_end, 0.15f, 1.3f},
                faces(k_face_top | k_face_front | k_face_left | k_face_right, m.stone));
    builder.box({-k_end, 0, k_edge}, {k_end, 0.3f, 0.95f},
                faces(k_face_top | k_face_front | k_face_left | k_face_right, m.stone));
    builder.box({-k_end, 0, k_back}, {k_end, k_floor, k_edge},
                faces(k_face_front | k_face_left | k_face_right, m.stone));
    builder.begin_object("floor");
    builder.quad({-k_end, k_floor, k_edge}, {2 * k_end, 0, 0}, {0, 0, k_back - k_edge}, surface(m.tiles));
    // A texture of four tiles over 2 m.
    for (Vec2& uv : builder.scene().meshes.back().uv[0]) uv = uv * 0.5f;
}

/// Back and end walls: plaster above a painted dado within, plain and coarse without.
void add_walls(SceneBuilder& builder, const Materials& m) {
    constexpr float k_dado = k_floor + 1.1f, k_outside = 0.3f;
    constexpr float x = k_end, outer_x = k_end + k_thickness, outer_z = k_back - k_thickness;
    const auto inner_face = [&](Vec3 corner, Vec3 right) {
        builder.quad(corner, right, {0, k_dado - k_floor, 0}, surface(m.dado));
        builder.quad(corner + Vec3{0, k_dado - k_floor, 0}, right, {0, k_ceiling - k_dado, 0}, surface(m.plaster));
    };
    builder.begin_object("back wall");
    inner_face({-x, k_floor, k_back}, {2 * x, 0, 0});
    builder.box({-outer_x, 0, outer_z}, {outer_x, k_ceiling, k_back},
                faces(k_face_back | k_face_left | k_face_right, m.plaster, k_outside));
    builder.begin_object("left wall");
    inner_face({-x, k_floor, k_half_wall}, {0, 0, k_back - k_half_wall});
    builder.box({-outer_x, 0, k_back}, {-x, k_ceiling, k_half_wall},
                faces(k_face_left | k_face_front, m.plaster, k_outside));
    builder.begin_object("right wall");
    inner_face({x, k_floor, k_back}, {0, 0, k_half_wall - k_back});
    builder.box({x, 0, k_back}, {outer_x, k_ceiling, k_half_wall},
                faces(k_face_right | k_face_front, m.plaster, k_outside));
}

/// The wall above the columns: stops along x with the height of its lower edge, from left to right.
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
    // Both faces of the wall, from the arches up to the ceiling; the back one runs from right to left.
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

    // The arches from below.
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
    builder.quad({-x, k_ceiling, back}, {2 * x, 0, 0}, {0, 0, front - back}, surface(m.ceiling, 0.8f));
    builder.box({-x, k_ceiling, back}, {x, k_roof, front}, faces(k_face_top, m.roof, 0.2f));
    builder.box({-x, k_ceiling, back}, {x, k_roof, front}, faces(k_face_sides, m.stone, 0.6f));
    builder.begin_object("beams");
    for (int i = 0; i <= 2 * k_bays; ++i) {
        const float centre = -k_half_length + 0.5f * k_bay * static_cast<float>(i);
        builder.box({centre - 0.1f, k_ceiling - 0.24f, k_back}, {centre + 0.1f, k_ceiling, -k_half_wall},
                    faces(k_face_left | k_face_right | k_face_bottom, m.timber, 0.8f));
    }
}

/// A half ring of a moulding: a bulge between two heights that meets `radius` at both.
void add_bulge(std::vector<ProfilePoint>& profile, float radius, float bulge, float low, float high) {
    constexpr int k_steps = 5;
    for (int i = 0; i <= k_steps; ++i) {
        const double angle = k_pi * (static_cast<double>(i) / k_steps - 0.5);
        const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
        profile.push_back({radius + bulge * c, 0.5f * (low + high) + 0.5f * (high - low) * s, {c, s}});
    }
}

/// A column with a square plinth, a round base, a shaft that swells a little, and a capital.
void add_column(SceneBuilder& builder, const Materials& m, float x, int number) {
    constexpr float k_base = 0.14f, k_shaft = 0.36f, k_neck = 2.42f, k_abacus = 2.68f, k_top_of = 2.8f, k_half = 0.35f;
    builder.begin_object("column " + std::to_string(number));
    const auto slab = [&](float low, float high, unsigned which) {
        builder.box({x - k_half, k_floor + low, -k_half}, {x + k_half, k_floor + high, k_half}, faces(which, m.stone));
    };
    slab(0, k_base, k_face_sides | k_face_top);
    slab(k_abacus, k_top_of, k_face_all);

    const Vec3 foot{x, k_floor, 0};
    std::vector<ProfilePoint> profile;
    add_bulge(profile, 0.27f, 0.06f, k_base, k_shaft);
    builder.lathe(foot, profile, k_column_segments, surface(m.stone));
    profile.clear();
    for (int i = 0; i <= 4; ++i) {
        const auto t = static_cast<float>(i) / 4;
        profile.push_back({0.26f - 0.045f * t * t, k_shaft + (k_neck - k_shaft) * t, {1, 0.04f * t}});
    }
    builder.lathe(foot, profile, k_column_segments, surface(m.stone));
    profile.clear();
    for (int i = 0; i <= 5; ++i) {
        const double angle = 0.5 * k_pi * i / 5;
        const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
        profile.push_back({0.215f + 0.12f * (1 - c), k_neck + (k_abacus - k_neck) * s, {s + 0.35f * c, -s - 0.1f}});
        profile.back().normal =
            profile.back().normal * (1 / std::hypot(profile.back().normal.x, profile.back().normal.y));
    }
    builder.lathe(foot, profile, k_column_segments, surface(m.stone));
}

/// Cloth that hangs from a rod between two columns, gathered at the top.
struct Curtain {
    const char* name;
    int bay;
    float left, right;   ///< from the bay's centre [m]
    float folds, phase;  ///< how many; of the first [radians]
    std::uint32_t material;
};

void add_curtain(SceneBuilder& builder, const Curtain& curtain) {
    constexpr float k_rod = k_spring - 0.2f, k_hem = k_floor + 0.12f;
    const float centre = -k_half_length + (static_cast<float>(curtain.bay) + 0.5f) * k_bay;
    const float width = curtain.right - curtain.left;
    const auto at = [&](float u, float v) {
        // Folds deepen downwards, lean with the height, and the whole swings a little inwards.
        const float depth = 0.02f + 0.04f * (1 - v);
        const float wave =
            std::sin(2 * std::numbers::pi_v<float> * (curtain.folds * u + 0.12f * std::sin(3 * v)) + curtain.phase);
        const float swing = 0.10f * std::sin(std::numbers::pi_v<float> * (1 - v) * 0.8f);
        return Vec3{centre + curtain.left + u * width + 0.03f * std::sin(5 * v + curtain.phase) * (1 - v),
                    k_hem + v * (k_rod - k_hem), depth * wave - swing};
    };
    PatchOptions options;
    options.columns = 10 * static_cast<std::size_t>(curtain.folds);
    options.rows = 6;
    options.size = {1.15f * width, k_rod - k_hem};
    options.material = curtain.material;
    builder.begin_object(curtain.name);
    builder.patch(options, [&](float u, float v) {
        constexpr float k_step = 1e-3f;
        const Vec3 along = at(u + k_step, v) - at(u - k_step, v), up = at(u, v + k_step) - at(u, v - k_step);
        return PatchPoint{at(u, v), normalize(cross(along, up)), {u * width, v * (k_rod - k_hem)}};
    });
}

void add_rods(SceneBuilder& builder, const Materials& m) {
    builder.begin_object("rods");
    PatchOptions options = surface(m.bronze);
    options.columns = 8;
    constexpr float k_radius = 0.02f, k_length = k_bay - 0.42f;
    options.size = {static_cast<float>(2 * k_pi) * k_radius, k_length};
    for (int bay = 0; bay < k_bays; ++bay) {
        const float left = -k_half_length + static_cast<float>(bay) * k_bay + 0.21f;
        builder.patch(options, [&](float u, float v) {
            const double angle = u == 1 ? 0 : 2 * k_pi * static_cast<double>(u);
            const Vec3 out{0, static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
            return PatchPoint{Vec3{left + k_length * v, k_spring - 0.2f, 0} + out * k_radius, out, {u, v}};
        });
    }
}

/// A terracotta pot with a round bush, before a column.
void add_pot(SceneBuilder& builder, const Materials& m, Vec3 foot, int number) {
    builder.begin_object("pot " + std::to_string(number));
    const std::array<ProfilePoint, 5> pot{{{0.16f, 0, {0.97f, -0.24f}},
                                           {0.23f, 0.3f, {0.97f, -0.24f}},
                                           {0.25f, 0.42f, {0.97f, 0.1f}},
                                           {0.25f, 0.46f, {0.5f, 0.87f}},
                                           {0.02f, 0.44f, {0, 1}}}};
    builder.lathe(foot, pot, 14, surface(m.terracotta));
    std::vector<ProfilePoint> bush;
    for (int i = 0; i <= 7; ++i) {
        const double angle = k_pi * (static_cast<double>(i) / 7 - 0.5) * 0.97;
        const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
        bush.push_back({0.36f * c, 0.78f + 0.36f * s, {c, s}});
    }
    builder.lathe(foot, bush, 14, surface(m.leaves, 0.6f));
}

void add_cypress(SceneBuilder& builder, const Materials& m, Vec3 foot, float height, int number) {
    builder.begin_object("cypress " + std::to_string(number));
    std::vector<ProfilePoint> profile;
    for (int i = 0; i <= 8; ++i) {
        // A spindle, thickest at a quarter of its height.
        const double t = i / 8.0;
        const double radius = 0.02 + 0.62 * std::pow(t, 0.45) * std::pow(1 - t, 0.8) * 1.6;
        const double slope = 0.62 * 1.6 * (t <= 0 ? 1 : radius * (0.45 / (t + 0.02) - 0.8 / (1.02 - t)));
        const double l = std::hypot(static_cast<double>(height), slope);
        profile.push_back({static_cast<float>(radius),
                           static_cast<float>(t) * height,
                           {static_cast<float>(height / l), static_cast<float>(-slope / l)}});
    }
    builder.lathe(foot, profile, 12, surface(m.leaves, 0.25f));
}

void add_light(Scene& scene, const ColonnadeOptions& options) {
    SkyOptions sky;
    sky.sun_elevation = options.sun_elevation;
    sky.sun_azimuth = options.sun_azimuth;
    set_sky(scene, sky, options.sky_height);
}

/// A camera at `eye` that looks at `target`.
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
        {{-10.5f, 0, 11}, {-5.8f, 0, 12.2f}, {-1.2f, 0, 11.4f}, {3.4f, 0, 12}, {-9.6f, 0, 1.5f}, {-10.4f, 0, -2.6f}}};
    for (std::size_t i = 0; i < k_trees.size(); ++i)
        add_cypress(builder, m, k_trees[i], 4.4f + 0.5f * static_cast<float>(i * 2 % 3), static_cast<int>(i + 1));
    Scene scene = builder.finish({.grid = 512, .padding = 4});
    add_light(scene, options);
    scene.cameras.push_back(look("gallery", {5.75f, 2.0f, -3.0f}, {-2.4f, 1.85f, -0.55f}, 0.95f));
    scene.cameras.push_back(look("garden", {7.8f, 2.3f, 9.2f}, {-1.6f, 2.3f, -0.5f}, 0.66f));
    return scene;
}

}  // namespace lobelia
