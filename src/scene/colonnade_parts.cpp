// The parts of the colonnade.
#include "scene/colonnade_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lobelia::colonnade {
namespace {

constexpr std::size_t k_column_segments = 16;

/// Adds the profile of a moulding: a half round between two heights that starts and ends at `radius`.
void add_bulge(std::vector<ProfilePoint>& profile, float radius, float bulge, float low, float high) {
    constexpr int k_steps = 5;
    for (int i = 0; i <= k_steps; ++i) {
        const double angle = k_pi * (static_cast<double>(i) / k_steps - 0.5);
        const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
        profile.push_back({radius + bulge * c, 0.5f * (low + high) + 0.5f * (high - low) * s, {c, s}});
    }
}

/// Adds the horizontal face of a slab around a column: between the slab's edge and a circle.
void add_ring(SceneBuilder& builder, Vec3 centre, float radius, Vec3 normal, std::uint32_t material) {
    PatchOptions options = surface(material);
    options.columns = k_column_segments;
    options.size = {static_cast<float>(k_pi) * (radius + k_slab), k_slab - radius};
    builder.patch(options, [&](float u, float v) {
        // Go around in the direction of the lathe, inwards on an upper face and outwards on a lower one.
        const double angle = u == 1 ? 0 : 2 * k_pi * static_cast<double>(u);
        const auto s = static_cast<float>(std::sin(angle)), c = static_cast<float>(std::cos(angle));
        const bool on_circle = (v == 1) == (normal.y > 0);
        const float reach = on_circle ? radius : k_slab / std::max(std::abs(s), std::abs(c));
        return PatchPoint{centre + Vec3{reach * s, 0, reach * c}, normal, {u * options.size.x, v * options.size.y}};
    });
}

}  // namespace

BoxOptions faces(unsigned which, std::uint32_t material, float density) {
    BoxOptions options;
    options.faces = which;
    options.material = material;
    options.density = density;
    return options;
}

PatchOptions surface(std::uint32_t material, float density) {
    PatchOptions options;
    options.material = material;
    options.density = density;
    return options;
}

/// Adds a column with a square plinth, a round base, a shaft with entasis, and a capital.
void add_column(SceneBuilder& builder, const Materials& m, float x, int number) {
    constexpr float k_shaft = 0.36f, k_neck = 2.42f, k_base_radius = 0.27f, k_capital_radius = 0.335f;
    builder.begin_object("column " + std::to_string(number));
    const Vec3 foot{x, k_floor, 0};
    // The outer columns touch the end walls, which end behind the slabs' front edges: leave out the covered part of the
    // face.
    const unsigned at_wall = number == 1 ? +k_face_left : number == k_bays + 1 ? +k_face_right : 0u;
    const auto slab = [&](float low, float high) {
        const Vec3 lowest = foot + Vec3{-k_slab, low, -k_slab}, highest = foot + Vec3{k_slab, high, k_slab};
        builder.box(lowest, highest, faces(k_face_sides & ~at_wall, m.stone));
        builder.box({lowest.x, lowest.y, k_half_wall}, highest, faces(at_wall, m.stone));
    };
    slab(0, k_plinth_top);
    add_ring(builder, foot + Vec3{0, k_plinth_top, 0}, k_base_radius, {0, 1, 0}, m.stone);
    slab(k_abacus, k_abacus_top);
    add_ring(builder, foot + Vec3{0, k_abacus, 0}, k_capital_radius, {0, -1, 0}, m.stone);
    // Add the capital's top in front of and behind the arcade's wall.
    for (const auto& [near, far] : {std::pair{-k_slab, -k_half_wall}, std::pair{k_half_wall, k_slab}})
        builder.box({x - k_slab, k_floor + k_abacus, near}, {x + k_slab, k_floor + k_abacus_top, far},
                    faces(k_face_top, m.stone));

    std::vector<ProfilePoint> profile;
    add_bulge(profile, k_base_radius, 0.06f, k_plinth_top, k_shaft);
    profile.push_back({0.26f, k_shaft, {0, 1}});
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
        profile.push_back({0.215f + (k_capital_radius - 0.215f) * (1 - c),
                           k_neck + (k_abacus - k_neck) * s,
                           {s + 0.35f * c, -s - 0.1f}});
        profile.back().normal =
            profile.back().normal * (1 / std::hypot(profile.back().normal.x, profile.back().normal.y));
    }
    builder.lathe(foot, profile, k_column_segments, surface(m.stone));
}

void add_curtain(SceneBuilder& builder, const Curtain& curtain) {
    constexpr float k_rod = k_spring - 0.2f, k_hem = k_floor + 0.12f;
    const float centre = -k_half_length + (static_cast<float>(curtain.bay) + 0.5f) * k_bay;
    const float width = curtain.right - curtain.left;
    const auto at = [&](float u, float v) {
        // Deepen the folds downwards, shift them with the height, and curve the cloth a little inwards.
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

/// Adds a terracotta pot with a round bush in front of a column.
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
        bush.push_back({0.36f * c, 0.81f + 0.36f * s, {c, s}});
    }
    builder.lathe(foot, bush, 14, surface(m.leaves, 0.6f));
}

void add_cypress(SceneBuilder& builder, const Materials& m, Vec3 foot, float height, int number) {
    builder.begin_object("cypress " + std::to_string(number));
    std::vector<ProfilePoint> profile;
    for (int i = 0; i <= 8; ++i) {
        // Make a spindle, thickest at a quarter of its height.
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

}  // namespace lobelia::colonnade
