// Problems of lightmap UVs and the cost of a bake, known before any ray is traced.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lobelia/bake_job.h"
#include "lobelia/result.h"
#include "lobelia/scene.h"

namespace lobelia {

/// Memory that a bake needs [bytes].
struct BakeMemory {
    std::size_t scene = 0;      ///< all objects laid out in the world, and the tree of their triangles
    std::size_t states = 0;     ///< encoder states of all texels; a bake may keep them region by region
    std::size_t pages = 0;      ///< the result
    std::size_t texels = 0;     ///< owner of each texel
    std::size_t finishing = 0;  ///< work buffers of the denoiser, after the states are freed
    [[nodiscard]] std::size_t total() const { return scene + pages + texels + std::max(states, finishing); }
};

/// Status of a texel; if several apply, the most severe.
enum class TexelMark : std::uint8_t { empty, covered, tight, overlap };

struct Preflight {
    /// Figures of each object, in the scene's order.
    struct OfObject {
        bool has_uv = false;
        std::size_t triangles = 0;
        std::size_t overlapping_texels = 0;    ///< centre covered by another triangle, too
        std::size_t tight_texels = 0;          ///< nearer to another chart than the padding
        std::size_t outside_triangles = 0;     ///< UVs outside [0, 1]: not baked there
        std::size_t degenerate_triangles = 0;  ///< no area in the world
        std::size_t unmapped_triangles = 0;    ///< area in the world, but none on the page
        std::size_t non_manifold_edges = 0;    ///< shared by three or more triangles
        std::size_t texels = 0;
        double area = 0;              ///< in the world, of parts with lightmap UVs [m^2]
        double texels_per_metre = 0;  ///< root of texel area over world area
    };
    /// Texels where triangles of two objects (or of one, if both are the same) overlap.
    struct Overlap {
        std::uint32_t object = 0, other = 0;  ///< object <= other
        std::size_t texels = 0;
    };
    /// Histogram of texels per metre over the world's area.
    struct Density {
        double least = 0, median = 0, most = 0;
        double first = 0;           ///< lower end of the first bin; each bin spans a factor of sqrt(2)
        std::vector<double> share;  ///< fraction of the area in each bin
    };
    /// Texels of one page, row by row.
    struct PageMarks {
        std::vector<TexelMark> mark;
        std::vector<std::uint32_t> chart;  ///< plus 1; 0: not covered
    };

    std::size_t width = 0, height = 0, texels = 0;
    std::size_t charts = 0;
    std::vector<OfObject> objects;
    std::vector<std::uint32_t> object_of_chart;
    std::vector<Overlap> overlaps;             ///< most texels first
    std::size_t padding = 0;                   ///< texels required between charts
    std::optional<std::size_t> least_padding;  ///< the least found, where that is below `padding`
    Density density;
    BakeMemory memory;
    std::optional<double> seconds;  ///< estimated duration of the bake
    std::vector<PageMarks> pages;
};

/// Lays out the pages and measures the ray rate for a quarter of a second. Errors as those of bake() before its first
/// ray; an early stop, when `stop` becomes true, is an error too.
[[nodiscard]] Result<Preflight> preflight(const Scene& scene, const BakeJob& job,
                                          const std::atomic<bool>* stop = nullptr);

/// Returns one sentence for each problem, with the objects' names; none if there is no problem.
[[nodiscard]] std::vector<std::string> warnings(const Preflight& preflight, const Scene& scene);
/// Returns the whole preflight as lines for a terminal, warnings included.
[[nodiscard]] std::string to_text(const Preflight& preflight, const Scene& scene);

}  // namespace lobelia
