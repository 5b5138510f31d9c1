// The atlas: layout, charts, and the triangles of each tile.
#include "bake/place/atlas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bake/place/charts.h"
#include "bake/place/layout.h"

namespace lobelia {
namespace {

/// Limits: side of a page, and texels of all pages.
constexpr std::size_t k_most_side = 16384;
constexpr std::size_t k_most_texels = std::size_t{1} << 31;
/// Limits of rasterisation: texels tested, and triangles listed for tiles. A million triangles that fill a page of 4096
/// x 4096 once take less than a hundredth of either.
constexpr std::uint64_t k_most_tests = std::uint64_t{1} << 32;
constexpr std::uint64_t k_most_listed = std::uint64_t{1} << 26;

/// Clamp for UVs [texels]; a float of this size can be squared and summed in double precision.
constexpr float k_far = 1e18f;

std::size_t tiles_along(std::size_t texels) { return (texels + k_tile - 1) / k_tile; }

Status check(const World& world, const AtlasOptions& options) {
    if (options.width == 0 || options.height == 0 || options.width > k_most_side || options.height > k_most_side)
        return Error{fmt::format("pages of {} x {} texels: each side must be 1 to {}", options.width, options.height,
                                 k_most_side)};
    if (options.padding > k_most_side)
        return Error{fmt::format("padding of {} texels: at most {}", options.padding, k_most_side)};
    if (const auto& d = options.texels_per_metre; d && !(*d > 0 && std::isfinite(*d)))
        return Error{fmt::format("{} texels per metre: must be above 0", *d)};
    if (options.texels_per_metre && options.layout == AtlasOptions::Layout::shared)
        return Error{"texels per metre set the size of each object, which requires the packed layout"};
    if (std::none_of(world.has_lightmap_uv.begin(), world.has_lightmap_uv.end(), [](auto has) { return has != 0; }))
        return Error{"no object has lightmap UVs; `lobelia unwrap` makes them"};
    return Done{};
}

}  // namespace

Result<Atlas> Atlas::make(const World& world, const AtlasOptions& options, StopFlag stop) {
    if (auto status = check(world, options); !status) return status.error();
    Atlas atlas;
    atlas.world_ = &world;
    atlas.stop_ = stop;
    atlas.width_ = options.width;
    atlas.height_ = options.height;
    if (auto status = atlas.find_placements(options); !status) return status.error();
    atlas.charts_ = find_charts(world, k_no_chart, stop);
    atlas.stop_ = {};
    return atlas;
}

Status Atlas::find_placements(const AtlasOptions& options) {
    using Layout = AtlasOptions::Layout;
    if (options.layout != Layout::automatic) return place(options, options.layout);
    if (options.texels_per_metre) return place(options, Layout::packed);
    const auto& has_uv = world_->has_lightmap_uv;
    if (std::count_if(has_uv.begin(), has_uv.end(), [](auto has) { return has != 0; }) == 1)
        return place(options, Layout::shared);
    // Pack separate rectangles if objects overlap, or if the UVs overlap too often for `place`: where the overlap is
    // within one object, it fails again and reports the error.
    if (const Status status = place(options, Layout::shared); status && !objects_overlap()) return status;
    return place(options, Layout::packed);
}

Status Atlas::place(const AtlasOptions& options, AtlasOptions::Layout layout) {
    ObjectPlacements result;
    if (layout == AtlasOptions::Layout::shared) {
        result = shared_layout(*world_, options);
    } else {
        Result<ObjectPlacements> packed = packed_layout(*world_, options, stop_);
        if (!packed) return packed.error();
        result = std::move(*packed);
    }
    if (result.pages > k_most_texels / (width_ * height_))
        return Error{fmt::format("the atlas would have {} pages of {} x {} texels: choose fewer texels per metre",
                                 result.pages, width_, height_)};
    layout_ = layout;
    placements_ = std::move(result.placements);
    pages_ = result.pages;
    return fill_tiles();
}

std::array<Vec2, 3> Atlas::texel_triangle(std::size_t t) const {
    const AtlasPlacement& placement = placements_[world_->object[t]];
    std::array<Vec2, 3> result;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec2 uv = world_->lightmap_uv[world_->triangles[t][i]];
        result[i] = {std::clamp(placement.scale.x * uv.x + placement.offset.x, -k_far, k_far),
                     std::clamp(placement.scale.y * uv.y + placement.offset.y, -k_far, k_far)};
    }
    return result;
}

std::size_t Atlas::tile_of(const CoveredTexel& texel) const {
    const std::size_t columns = tiles_along(width_), rows = tiles_along(height_);
    return (texel.page * rows + texel.y / k_tile) * columns + texel.x / k_tile;
}

std::uint32_t Atlas::page_of_tile(std::size_t tile) const {
    return static_cast<std::uint32_t>(tile / (tiles_along(width_) * tiles_along(height_)));
}

TexelBox Atlas::box_of_tile(std::size_t tile) const {
    const std::size_t columns = tiles_along(width_), rows = tiles_along(height_);
    const std::size_t x = tile % columns * k_tile, y = tile / columns % rows * k_tile;
    return {static_cast<int>(x), static_cast<int>(y), static_cast<int>(std::min(x + k_tile, width_)),
            static_cast<int>(std::min(y + k_tile, height_))};
}

Status Atlas::fill_tiles() {
    const std::size_t columns = tiles_along(width_), rows = tiles_along(height_), count = pages_ * columns * rows;
    constexpr int k_side = static_cast<int>(k_tile);
    const auto for_each_tile = [&](std::size_t t, const auto& visit) {
        stop_.check();
        const AtlasPlacement& placement = placements_[world_->object[t]];
        if (!placement.baked) return;
        const PageTriangle triangle(texel_triangle(t));
        const TexelBox box = triangle.box(placement.texels);
        if (triangle.degenerate() || box.empty()) return;
        for (int y = box.y0 / k_side; y <= (box.y1 - 1) / k_side; ++y)
            for (int x = box.x0 / k_side; x <= (box.x1 - 1) / k_side; ++x) {
                const TexelBox part = intersection(box, {x * k_side, y * k_side, (x + 1) * k_side, (y + 1) * k_side});
                if (triangle.may_touch(part)) visit((placement.page * rows + y) * columns + x, part);
            }
    };

    // Count the triangles of each tile, and their cost.
    std::vector<std::uint64_t> first(count + 1);
    std::uint64_t tests = 0, listed = 0;
    for (std::size_t t = 0; t < world_->triangles.size(); ++t) {
        for_each_tile(t, [&](std::size_t tile, const TexelBox& part) {
            ++first[tile + 1];
            ++listed;
            tests += static_cast<std::uint64_t>(part.x1 - part.x0) * static_cast<std::uint64_t>(part.y1 - part.y0);
        });
        if (tests > k_most_tests || listed > k_most_listed)
            return Error{
                fmt::format("the lightmap UVs overlap many times over (up to {}): `lobelia unwrap` makes new ones",
                            world_->name_of(world_->object[t]))};
    }

    // List the triangles tile by tile.
    for (std::size_t i = 0; i < count; ++i) first[i + 1] += first[i];
    first_of_tile_.assign(first.begin(), first.end());
    triangles_of_tiles_.resize(first.back());
    for (std::size_t t = 0; t < world_->triangles.size(); ++t)
        for_each_tile(t, [&](std::size_t tile, const TexelBox&) {
            triangles_of_tiles_[first[tile]++] = static_cast<std::uint32_t>(t);
        });
    return Done{};
}

bool Atlas::objects_overlap() const {
    // The margin tolerates borders that overlap by float32 rounding.
    constexpr double k_margin = 1e-3;
    std::vector<std::uint32_t> owner(k_tile * k_tile);
    for (std::size_t tile = 0; tile < tiles(); ++tile) {
        const TexelBox box = box_of_tile(tile);
        constexpr std::uint32_t k_no_triangle = 0xffffffff;
        std::fill(owner.begin(), owner.end(), k_no_triangle);
        for (const std::uint32_t t : triangles_of_tile(tile)) {
            stop_.check();
            const PageTriangle triangle(texel_triangle(t));
            const TexelBox part = box_of(t, triangle, box);
            for (int y = part.y0; y < part.y1; ++y)
                for (int x = part.x0; x < part.x1; ++x) {
                    std::uint32_t& other = owner[static_cast<std::size_t>(y - box.y0) * k_tile + (x - box.x0)];
                    if (other == world_->object[t] || !triangle.contains({x + 0.5, y + 0.5}, k_margin)) continue;
                    if (other != k_no_triangle) return true;
                    other = world_->object[t];
                }
        }
    }
    return false;
}

}  // namespace lobelia
