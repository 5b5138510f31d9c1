// Lightmap pages: where each object's UVs lie on them, which texels its triangles cover, and in which charts.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "bake/place/plane.h"
#include "lobelia/bake_job.h"
#include "lobelia/lightmap.h"
#include "lobelia/result.h"
#include "scene/world.h"

namespace lobelia {

/// Texels are kept in tiles of k_tile x k_tile.
inline constexpr std::size_t k_tile = 32;

/// One texel that some triangle covers.
struct CoveredTexel {
    std::uint32_t page = 0, x = 0, y = 0;
};

class Atlas {
  public:
    /// The world must outlive the atlas. An error where an object does not fit a page, no object has lightmap UVs or
    /// they overlap hundreds of times over (the messages name `lobelia unwrap`). Throws Stopped.
    [[nodiscard]] static Result<Atlas> make(const World& world, const AtlasOptions& options, StopFlag stop = {});

    [[nodiscard]] std::size_t width() const { return width_; }
    [[nodiscard]] std::size_t height() const { return height_; }
    [[nodiscard]] std::size_t pages() const { return pages_; }
    [[nodiscard]] const std::vector<AtlasPlacement>& placements() const { return placements_; }  ///< of each object
    [[nodiscard]] AtlasOptions::Layout layout() const { return layout_; }                        ///< as chosen
    /// Vertices of triangle t on its page [texels], of a size that double precision can square.
    [[nodiscard]] std::array<Vec2, 3> texel_triangle(std::size_t t) const;
    [[nodiscard]] std::uint32_t page_of(std::size_t t) const { return placements_[world_->object[t]].page; }

    /// Chart of each triangle: those connected through shared vertices in UV space; k_no_chart if it is not baked.
    [[nodiscard]] const std::vector<std::uint32_t>& chart_of_triangle() const { return charts_; }
    static constexpr std::uint32_t k_no_chart = 0xffffffff;

    /// Tiles of all pages, page by page, row by row; those at the right and bottom may hang over.
    [[nodiscard]] std::size_t tiles() const { return first_of_tile_.empty() ? 0 : first_of_tile_.size() - 1; }
    [[nodiscard]] std::size_t tile_of(const CoveredTexel& texel) const;
    [[nodiscard]] std::uint32_t page_of_tile(std::size_t tile) const;
    /// The tile's texels, cut to the page.
    [[nodiscard]] TexelBox box_of_tile(std::size_t tile) const;
    /// Triangles that may touch the tile, in order; none that is too thin to own texels.
    [[nodiscard]] std::span<const std::uint32_t> triangles_of_tile(std::size_t tile) const {
        return std::span(triangles_of_tiles_)
            .subspan(first_of_tile_[tile], first_of_tile_[tile + 1] - first_of_tile_[tile]);
    }
    /// The texels of box_of_tile that triangle t may cover.
    [[nodiscard]] TexelBox box_of(std::size_t t, const PageTriangle& triangle, const TexelBox& tile) const {
        return triangle.box(intersection(placements_[world_->object[t]].texels, tile));
    }

    [[nodiscard]] const World& world() const { return *world_; }

  private:
    [[nodiscard]] Status find_placements(const AtlasOptions& options);
    [[nodiscard]] Status place(const AtlasOptions& options, AtlasOptions::Layout layout);
    [[nodiscard]] Status fill_tiles();
    [[nodiscard]] bool objects_overlap() const;

    const World* world_ = nullptr;
    StopFlag stop_;
    std::size_t width_ = 0, height_ = 0, pages_ = 0;
    AtlasOptions::Layout layout_ = AtlasOptions::Layout::shared;
    std::vector<AtlasPlacement> placements_;
    std::vector<std::uint32_t> charts_;
    std::vector<std::uint32_t> first_of_tile_, triangles_of_tiles_;
};

/// Which triangle owns each texel of each page, by conservative rasterisation: the triangle that holds the texel's
/// centre, or else the one that covers most of it (at least k_least_cover); of equals the first. Texels in order: page,
/// then tiles of k_tile x k_tile row by row, then rows within the tile. That order is the order of everything that is
/// kept for texels.
struct TexelMap {
    std::vector<CoveredTexel> texels;
    std::vector<std::uint32_t> triangle;       ///< that owns each
    std::vector<std::uint32_t> first_of_tile;  ///< index of the first texel of each tile that has any, and the end
};
/// Throws Stopped.
[[nodiscard]] TexelMap map_texels(const Atlas& atlas, StopFlag stop = {});

/// Share of a texel that a triangle must cover: less is what float32 UVs are off by on a large page.
inline constexpr double k_least_cover = 1e-4;

}  // namespace lobelia
