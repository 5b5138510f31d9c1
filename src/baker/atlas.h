// Lightmap pages: where each object's UVs lie on them, which texels its triangles cover, and in which charts.
#pragma once

#include <optional>
#include <vector>

#include "lobelia/result.h"
#include "scene/world.h"

namespace lobelia {

struct AtlasOptions {
    std::size_t width = 512, height = 512;   ///< of a page [texels]
    std::optional<double> texels_per_metre;  ///< sizes objects by area instead of keeping their common UV square
    std::size_t padding = 2;                 ///< texels between objects that are packed
    /// shared: all objects lie in one UV square together, without overlaps, as an unwrapper of whole scenes leaves
    /// them. packed: each object has the UV square for itself; squares are packed into pages. automatic: shared if
    /// nothing overlaps between objects and no texels_per_metre is asked for.
    enum class Layout { automatic, shared, packed } layout = Layout::automatic;
};

/// page texel = scale * uv + offset, both axes; texel centres at + 0.5, uv (0, 0) at the top left.
struct AtlasPlacement {
    std::uint32_t page = 0;
    Vec2 scale, offset;
    bool baked = false;  ///< the object has lightmap UVs
};

/// One texel that some triangle touches.
struct CoveredTexel {
    std::uint32_t page = 0, x = 0, y = 0;
};

class Atlas {
  public:
    /// An error where an object does not fit a page, or no object has lightmap UVs (the message names `lobelia
    /// unwrap`).
    [[nodiscard]] static Result<Atlas> make(const World& world, const AtlasOptions& options);

    [[nodiscard]] std::size_t width() const { return width_; }
    [[nodiscard]] std::size_t height() const { return height_; }
    [[nodiscard]] std::size_t pages() const { return pages_; }
    [[nodiscard]] const std::vector<AtlasPlacement>& placements() const { return placements_; }  ///< of each object
    [[nodiscard]] AtlasOptions::Layout layout() const { return layout_; }                        ///< as chosen
    /// Vertices of triangle t on its page [texels].
    [[nodiscard]] std::array<Vec2, 3> texel_triangle(std::size_t t) const;
    [[nodiscard]] std::uint32_t page_of(std::size_t t) const { return placements_[world_->object[t]].page; }

    /// Chart of each triangle: those connected through shared vertices in UV space; k_no_chart if it is not baked.
    [[nodiscard]] const std::vector<std::uint32_t>& chart_of_triangle() const { return charts_; }
    static constexpr std::uint32_t k_no_chart = 0xffffffff;

    [[nodiscard]] const World& world() const { return *world_; }

  private:
    const World* world_ = nullptr;
    std::size_t width_ = 0, height_ = 0, pages_ = 0;
    AtlasOptions::Layout layout_ = AtlasOptions::Layout::shared;
    std::vector<AtlasPlacement> placements_;
    std::vector<std::uint32_t> charts_;
};

/// Which triangle owns each texel of each page, by conservative rasterisation: the triangle that holds the texel's
/// centre, or else the one that covers most of it. Texels in order: page, then tiles of k_tile x k_tile row by row,
/// then rows within the tile. That order is the order of everything that is kept for texels.
inline constexpr std::size_t k_tile = 32;
struct TexelMap {
    std::vector<CoveredTexel> texels;
    std::vector<std::uint32_t> triangle;       ///< that owns each
    std::vector<std::uint32_t> first_of_tile;  ///< index of the first texel of each tile that has any, and the end
};
[[nodiscard]] TexelMap map_texels(const Atlas& atlas);

}  // namespace lobelia
