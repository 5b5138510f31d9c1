// Lightmap pages: the placement of each object's UVs, its charts, and the texels that its triangles cover.
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

/// A texel covered by a triangle.
struct CoveredTexel {
    std::uint32_t page = 0, x = 0, y = 0;
};

class Atlas {
  public:
    /// Makes an atlas. The world must outlive it. Errors: an object does not fit a page, no object has lightmap UVs, or
    /// they overlap hundreds of times over (the messages name `lobelia unwrap`). Throws Stopped.
    [[nodiscard]] static Result<Atlas> make(const World& world, const AtlasOptions& options, StopFlag stop = {});

    [[nodiscard]] std::size_t width() const { return width_; }
    [[nodiscard]] std::size_t height() const { return height_; }
    [[nodiscard]] std::size_t pages() const { return pages_; }
    [[nodiscard]] const std::vector<AtlasPlacement>& placements() const { return placements_; }  ///< one per object
    [[nodiscard]] AtlasOptions::Layout layout() const { return layout_; }                        ///< as chosen
    /// Returns the vertices of triangle t on its page [texels], clamped so that double precision can square them.
    [[nodiscard]] std::array<Vec2, 3> texel_triangle(std::size_t t) const;
    [[nodiscard]] std::uint32_t page_of(std::size_t t) const { return placements_[world_->object[t]].page; }

    /// Chart of each triangle: triangles connected through shared vertices in UV space; k_no_chart if it is not baked.
    [[nodiscard]] const std::vector<std::uint32_t>& chart_of_triangle() const { return charts_; }
    static constexpr std::uint32_t k_no_chart = 0xffffffff;

    /// Number of tiles of all pages, page by page, row by row; those at the right and bottom may exceed the page.
    [[nodiscard]] std::size_t tiles() const { return first_of_tile_.empty() ? 0 : first_of_tile_.size() - 1; }
    [[nodiscard]] std::size_t tile_of(const CoveredTexel& texel) const;
    [[nodiscard]] std::uint32_t page_of_tile(std::size_t tile) const;
    /// Returns the tile's texels, clipped to the page.
    [[nodiscard]] TexelBox box_of_tile(std::size_t tile) const;
    /// Returns the triangles that may touch the tile, in order, without those too thin to own texels.
    [[nodiscard]] std::span<const std::uint32_t> triangles_of_tile(std::size_t tile) const {
        return std::span(triangles_of_tiles_)
            .subspan(first_of_tile_[tile], first_of_tile_[tile + 1] - first_of_tile_[tile]);
    }
    /// Returns the texels of box_of_tile that triangle t may cover.
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

/// The triangle that owns each texel of each page, by conservative rasterisation: the one that contains the texel's
/// centre, or else the one that covers most of it (at least k_least_cover); the first of equals. Texels are ordered by
/// page, then by tiles of k_tile x k_tile row by row, then by rows within the tile. All arrays over texels use this
/// order.
struct TexelMap {
    std::vector<CoveredTexel> texels;
    std::vector<std::uint32_t> triangle;       ///< owner of each texel
    std::vector<std::uint32_t> first_of_tile;  ///< index of the first texel of each non-empty tile, and the end
};
/// Throws Stopped.
[[nodiscard]] TexelMap map_texels(const Atlas& atlas, StopFlag stop = {});

/// Minimum fraction of a texel that its owner covers: smaller ones are within the error of float32 UVs on a large page.
inline constexpr double k_least_cover = 1e-4;

}  // namespace lobelia
