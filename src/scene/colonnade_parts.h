// The parts of the colonnade: its dimensions, materials and objects.
//
// Surfaces end where others stand on them: points inside the building or a column see only back faces, so that the
// baker detects them as hidden.
#pragma once

#include "scene/scene_builder.h"

namespace lobelia::colonnade {

// Dimensions [m]. The arcade stands on z = 0 and faces +z; the gallery is behind it.
inline constexpr int k_bays = 4;
inline constexpr float k_bay = 3, k_half_length = 0.5f * k_bays * k_bay;
inline constexpr float k_floor = 0.45f;  // three steps
inline constexpr float k_spring = k_floor + 2.8f, k_arch_radius = 1.15f;
inline constexpr float k_ceiling = k_floor + 4.45f, k_roof = k_ceiling + 0.4f;
inline constexpr float k_half_wall = 0.25f;            // half thickness of the arcade
inline constexpr float k_end = k_half_length + 0.35f;  // inner face of the end walls
inline constexpr float k_back = -3.6f;                 // inner face of the back wall
inline constexpr float k_thickness = 0.3f;             // of back and end walls
inline constexpr float k_edge = 0.6f;                  // where the floor ends and the steps begin
inline constexpr std::size_t k_arch_segments = 16;
// Square slabs under and over each column, above the floor.
inline constexpr float k_slab = 0.35f;  // half of a side
inline constexpr float k_plinth_top = 0.14f, k_abacus = 2.68f, k_abacus_top = 2.8f;

struct Materials {
    std::uint32_t stone, plaster, dado, ceiling, timber, tiles, gravel, roof, red, blue, ochre, bronze, terracotta,
        leaves;
};

[[nodiscard]] Materials add_materials(SceneBuilder& builder);

/// Options of a box and of a patch; `density` is that of the lightmap, relative to other patches.
[[nodiscard]] BoxOptions faces(unsigned which, std::uint32_t material, float density = 1);
[[nodiscard]] PatchOptions surface(std::uint32_t material, float density = 1);

/// A curtain on a rod between two columns, gathered at the top.
struct Curtain {
    const char* name;
    int bay;
    float left, right;   ///< distance from the bay's centre [m]
    float folds, phase;  ///< number of folds; phase of the first [radians]
    std::uint32_t material;
};

/// Each function begins a new object.
void add_column(SceneBuilder& builder, const Materials& m, float x, int number);
void add_curtain(SceneBuilder& builder, const Curtain& curtain);
void add_rods(SceneBuilder& builder, const Materials& m);
void add_pot(SceneBuilder& builder, const Materials& m, Vec3 foot, int number);
void add_cypress(SceneBuilder& builder, const Materials& m, Vec3 foot, float height, int number);

}  // namespace lobelia::colonnade
