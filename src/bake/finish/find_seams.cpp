// Joins edges at the same position in pairs; splits the remaining ones at T-junctions and joins again.
#include "bake/finish/find_seams.h"

#include "bake/place/split_edges.h"

namespace lobelia {
namespace {

/// Cosine of the maximum angle between normals along one edge: 10 degrees.
constexpr float k_least_cosine = 0.98481f;

SeamSide side_of(const Atlas& atlas, const EdgePiece& piece) {
    const World& world = atlas.world();
    const std::array<Vec2, 3> corners = atlas.texel_triangle(piece.triangle);
    const std::size_t first = piece.side, second = (piece.side + 1u) % 3;
    const auto& vertices = world.triangles[piece.triangle];
    const auto end = [&](float at) { return corners[first] * (1 - at) + corners[second] * at; };
    const auto normal = [&](float at) {
        const Vec3 n = world.normals[vertices[first]] * (1 - at) + world.normals[vertices[second]] * at;
        const float size = length(n);
        return size > 0 ? n * (1 / size) : n;
    };
    const auto position = [&](float at) {
        return world.positions[vertices[first]] * (1 - at) + world.positions[vertices[second]] * at;
    };
    return {piece.triangle,
            {end(piece.at_low), end(piece.at_high)},
            {position(piece.at_low), position(piece.at_high)},
            {normal(piece.at_low), normal(piece.at_high)}};
}

/// Returns whether both sides are the same edge on the page: the interior of a chart.
bool same_on_page(const Atlas& atlas, const SeamSide& a, const SeamSide& b) {
    constexpr float k_near = 1e-2f;  // [texels]
    const auto near = [](Vec2 p, Vec2 q) { return std::hypot(p.x - q.x, p.y - q.y) < k_near; };
    return atlas.page_of(a.triangle) == atlas.page_of(b.triangle) && near(a.ends[0], b.ends[0]) &&
           near(a.ends[1], b.ends[1]);
}

/// Joins each piece to the nearest earlier one at the same position whose normals agree, so that three or more form a
/// chain. Returns the pieces without a partner.
std::vector<EdgePiece> join(const Atlas& atlas, std::span<const EdgePiece> pieces, StopFlag stop,
                            std::vector<Seam>& seams) {
    constexpr std::size_t k_most_back = 8;
    std::vector<std::uint8_t> joined(pieces.size());
    for (std::size_t i = 1; i < pieces.size(); ++i) {
        stop.check();
        for (std::size_t back = 1; back <= std::min(i, k_most_back) && pieces[i - back].same_place(pieces[i]); ++back) {
            if (pieces[i - back].triangle == pieces[i].triangle) continue;
            const SeamSide a = side_of(atlas, pieces[i - back]), b = side_of(atlas, pieces[i]);
            if (dot(a.normals[0], b.normals[0]) < k_least_cosine || dot(a.normals[1], b.normals[1]) < k_least_cosine)
                continue;
            joined[i] = joined[i - back] = 1;
            if (!same_on_page(atlas, a, b)) seams.push_back({a, b});
            break;
        }
    }
    std::vector<EdgePiece> left;
    for (std::size_t i = 0; i < pieces.size(); ++i)
        if (joined[i] == 0) left.push_back(pieces[i]);
    return left;
}

}  // namespace

std::vector<Seam> find_seams(const Atlas& atlas, float tolerance, StopFlag stop) {
    const World& world = atlas.world();
    const std::vector<std::uint32_t> welded = weld_positions(world, tolerance, stop);
    std::vector<EdgePiece> pieces;
    for (const WorldEdge& edge : sorted_edges(world, welded))
        if (atlas.placements()[world.object[edge.triangle]].baked) pieces.push_back(whole_piece(world, welded, edge));
    std::vector<Seam> seams;
    const std::vector<EdgePiece> left = join(atlas, pieces, stop, seams);
    join(atlas, split_edges(world, left, tolerance, stop), stop, seams);

    // Ignore edges longer than a page.
    const auto longest = static_cast<double>(atlas.width() + atlas.height());
    std::erase_if(seams, [&](const Seam& s) { return s.texels() > longest; });
    return seams;
}

}  // namespace lobelia
