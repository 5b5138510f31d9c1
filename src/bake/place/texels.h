// What a texel of a lightmap is in the world: points on its triangles, smooth normals, and whether it can be lit at
// all.
#pragma once

#include <vector>

#include "bake/place/atlas.h"
#include "trace/path_tracer.h"

namespace lobelia {

/// Samples of a texel start from up to this many points, spread over the part of it that its chart covers.
inline constexpr std::size_t k_most_positions = 4;

struct Texel {
    std::array<Vec3, k_most_positions> positions;  ///< lifted off the surface, pushed out of what buried them
    std::uint8_t position_count = 0;
    Vec3 normal;       ///< unit, smooth, at the texel's centre or the nearest covered point
    Vec3 face_normal;  ///< unit, of the owning triangle
    Vec3 position;     ///< on the surface, of the centre or the nearest covered point
    std::uint32_t object = 0, chart = 0;
    bool buried = false;  ///< could not be pushed out: it sees back faces all around
};

/// The texels [begin, end) of the map. Always the same for the same input, whatever range they are asked in.
/// `push_out` moves positions that lie closer than a texel's width behind another surface to its lit side.
void make_texels(const Atlas& atlas, const TexelMap& map, std::size_t begin, std::size_t end, const PathTracer& tracer,
                 Switch push_out, std::vector<Texel>& out);

/// The surface at the centre of texel i of the map, or at the covered point nearest to it.
struct TexelSurface {
    Vec3 position;
    Vec3 normal;  ///< unit, smooth
};
[[nodiscard]] TexelSurface surface_of(const Atlas& atlas, const TexelMap& map, std::size_t i);

/// Rows x, y, z: z is `normal`, x and y depend on it alone, so that charts that meet agree on them; and they change
/// with it as little as can be, so that neighbours may be averaged. No such frames exist without a pole; the only one
/// is at (-2, -3, -6) / 7, which walls, floors and ceilings do not face.
[[nodiscard]] Rotation tangent_from_world(Vec3 normal);

}  // namespace lobelia
