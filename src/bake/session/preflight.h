// What is wrong with an atlas and what its bake will take, told before any ray: as data, as text, as a picture.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "bake/gather/gather.h"
#include "bake/place/atlas.h"
#include "io/write_image.h"

namespace lobelia {

/// How fast light is traced here.
struct TraceRate {
    double rays_per_second = 0;
    double rays_per_sample = 0;
};
/// Traces a few samples from texels all over the atlas, on all threads, for a quarter of a second or so.
[[nodiscard]] TraceRate measure_rate(const Atlas& atlas, const TexelMap& map, const PathTracer& tracer,
                                     const GatherOptions& options = {});

/// Bytes that a bake needs at most at the same time, beside the scene.
struct BakeMemory {
    std::size_t states = 0;     ///< of the encoder, for all texels; a bake may keep them in parts
    std::size_t pages = 0;      ///< what comes out
    std::size_t texels = 0;     ///< which triangle owns each
    std::size_t finishing = 0;  ///< guides and work buffers of the denoiser, after the states are gone
    [[nodiscard]] std::size_t total() const { return pages + texels + std::max(states, finishing); }
};
[[nodiscard]] BakeMemory bake_memory(const Atlas& atlas, const TexelMap& map, std::size_t state_bytes,
                                     std::size_t channels);

struct PreflightOptions {
    /// Texels that must lie between charts. Bilinear filtering reads one beside each chart, and both are filled: 2. A
    /// renderer that reads mips down to level m needs 2^m times as many. (The denoiser stays within charts.)
    std::size_t padding = 2;
    std::size_t state_bytes = 0;    ///< of the encoder for each texel
    std::size_t channels = 0;       ///< of each page
    std::uint32_t samples = 256;    ///< of each texel
    std::optional<TraceRate> rate;  ///< without it there is no estimate of the time
};

/// What is known of a texel of a page, the worst of it.
enum class TexelMark : std::uint8_t { empty, covered, tight, overlap };

struct Preflight {
    /// Of each object, in the scene's order.
    struct OfObject {
        bool has_uv = false;
        std::size_t triangles = 0;
        std::size_t overlapping_texels = 0;    ///< whose centre other triangles hold, too
        std::size_t tight_texels = 0;          ///< nearer to another chart than the padding
        std::size_t outside_triangles = 0;     ///< with UVs out of [0, 1]: not baked there
        std::size_t degenerate_triangles = 0;  ///< without area in the world
        std::size_t unmapped_triangles = 0;    ///< with area in the world, but none on the page
        std::size_t non_manifold_edges = 0;    ///< of three triangles and more
        std::size_t texels = 0;
        double area = 0;              ///< in the world, of what has lightmap UVs [m^2]
        double texels_per_metre = 0;  ///< root of texel area over world area
    };
    /// Texels where triangles of these two objects (or of one, if they are the same) lie over each other.
    struct Overlap {
        std::uint32_t object = 0, other = 0;  ///< object <= other
        std::size_t texels = 0;
    };
    /// Texels per metre over the world's area.
    struct Density {
        double least = 0, median = 0, most = 0;
        double first = 0;           ///< lower end of the histogram; each bin ends at sqrt(2) times its beginning
        std::vector<double> share;  ///< of the area, in each bin
    };

    std::size_t width = 0, height = 0, pages = 0, texels = 0;
    std::size_t charts = 0;
    std::vector<OfObject> objects;
    std::vector<Overlap> overlaps;             ///< most texels first
    std::optional<std::size_t> least_padding;  ///< where below what is needed: the least that there is
    std::size_t padding = 0;                   ///< what is needed
    Density density;
    BakeMemory memory;
    std::optional<double> seconds;              ///< that the bake will take
    std::vector<std::vector<TexelMark>> marks;  ///< of each page's texels
};
[[nodiscard]] Preflight preflight(const Atlas& atlas, const TexelMap& map, const PreflightOptions& options = {});

/// What should be mended, one sentence each, with the objects' names from the scene; none if all is well.
[[nodiscard]] std::vector<std::string> warnings(const Preflight& preflight, const Scene& scene);
/// All of it as lines for a terminal, warnings included.
[[nodiscard]] std::string to_text(const Preflight& preflight, const Scene& scene);

/// Charts in colours of their own, overlaps red, too little padding orange, free texels dark; no side longer than
/// `most_side`, where a pixel that stands for several texels shows the worst.
[[nodiscard]] Image8 preflight_picture(const Preflight& preflight, const Atlas& atlas, const TexelMap& map,
                                       std::size_t page, std::size_t most_side = 2048);

}  // namespace lobelia
