// The triangles of a glTF primitive, whatever its topology and index type.
#include "scene/gltf_triangles.h"

#include <limits>

namespace lobelia::gltf {
namespace {

/// How many triangles so many indices make.
std::size_t triangle_count(int mode, std::size_t indices) {
    if (mode == TINYGLTF_MODE_TRIANGLES) return indices / 3;
    return indices < 3 ? 0 : indices - 2;
}

/// Positions within the index list of triangle t's corners, as glTF 2.0 (3.7.2.1) orders them.
std::array<std::size_t, 3> corners(int mode, std::size_t t) {
    if (mode == TINYGLTF_MODE_TRIANGLES) return {3 * t, 3 * t + 1, 3 * t + 2};
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) return {t, t + 1 + t % 2, t + 2 - t % 2};
    return {t + 1, t + 2, 0};
}

}  // namespace

bool has_triangles(int mode) {
    return mode == TINYGLTF_MODE_TRIANGLES || mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
           mode == TINYGLTF_MODE_TRIANGLE_FAN;
}

Result<std::vector<Triangle>> read_triangles(Document& document, const tinygltf::Primitive& primitive,
                                             std::size_t vertices, std::size_t most, const std::string& place) {
    // Open the indices; where there are none, vertices are taken in order.
    std::optional<Accessor> indices;
    const std::string at = place + ".indices";
    if (primitive.indices >= 0) {
        auto accessor = Accessor::open(document, primitive.indices, at);
        if (!accessor) return accessor.error();
        if (!accessor->is_unsigned() || accessor->components() != 1) return document.error(at, "not unsigned integers");
        indices = *std::move(accessor);
    }
    const std::size_t count = triangle_count(primitive.mode, indices ? indices->count() : vertices);
    if (count > most)
        return document.error(place, fmt::format("{} triangles; at most {} are left to be read", count, most));
    if (vertices > std::numeric_limits<std::uint32_t>::max())
        return document.error(place, fmt::format("{} vertices", vertices));

    // Take each corner, and see that it is there.
    std::vector<Triangle> triangles(count);
    for (std::size_t t = 0; t < count; ++t) {
        const auto positions = corners(primitive.mode, t);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t vertex =
                indices ? indices->index_at(positions[k]) : static_cast<std::uint32_t>(positions[k]);
            if (vertex >= vertices)
                return document.error(at, fmt::format("element {} is vertex {} of {}", positions[k], vertex, vertices));
            triangles[t][k] = vertex;
        }
    }
    return triangles;
}

}  // namespace lobelia::gltf
