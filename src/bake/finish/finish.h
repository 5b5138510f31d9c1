// The finishing steps, on pages of coefficients: seams, denoising, dilation. Each works in coefficient space, channel
// by channel, and knows no basis. Order: denoise, seams, dilate. Results do not depend on the number of threads. Each
// step that is given a StopFlag throws Stopped once it is set, and leaves the pages half done.
#pragma once

#include "bake/place/atlas.h"
#include "bake/place/texels.h"
#include "lobelia/basis.h"
#include "lobelia/lightmap.h"

namespace lobelia {

/// Positions and smooth normals of the covered texels, page by page, row by row: the guides of the denoiser.
struct Guides {
    std::vector<std::vector<Vec3>> position, normal;
};
/// Computes the same positions and normals as make_receivers.
[[nodiscard]] Guides make_guides(const Atlas& atlas, const TexelMap& map, StopFlag stop = {});

/// Makes both sides of each seam agree: where an edge of a triangle, or the part of it along a shorter edge, lies at
/// two places on the pages (of one object or of two that touch), the bilinearly filtered values along both become
/// equal, as they are after `dilate`. Solves least squares over the texels near seams: |difference along the seam|^2 +
/// weight |change|^2, one sparse system (Eigen) for each channel of all pages. Each texel stays within the range of the
/// texels that its seams filter, so that non-negative light stays non-negative. Positions within `tolerance` [m] and
/// normals within about 10 degrees count as the same edge.
struct SeamOptions {
    float weight = 0.05f;
    float tolerance = 1e-4f;
    float least_validity = 0.5f;  ///< as for `dilate`, which replaces texels below it
    StopFlag stop = {};
};
struct SeamReport {
    std::size_t edges = 0;         ///< joined pairs, of edges or of parts
    double before = 0, after = 0;  ///< RMS difference of the irradiance channels along the seams
};
/// Limits on what seams may mix: seams under a surface stay open, and texels whose samples were moved are ignored.
struct SeamSurroundings {
    const PathTracer* tracer = nullptr;                ///< null: no surface stands on seams
    std::vector<std::vector<std::uint8_t>> displaced;  ///< as displaced_texels returns it; empty: none
};
SeamReport close_seams(std::span<LightmapPage> pages, const PageChannels& channels, const Atlas& atlas,
                       const SeamOptions& options = {}, const SeamSurroundings& around = {});

/// Smooths noise within each chart, never across charts: an edge-avoiding filter guided by position and normal and
/// scaled by the measured standard error. Coefficients are divided by the texel's mean radiance (sum of c_i times
/// `integrals`, over the domain's solid angle) before filtering and multiplied by its filtered value after, so that
/// brightness does not blur directions (for SH: L1 / L0).
struct DenoiseOptions {
    int passes = 4;               ///< a-trous levels, 1 to 6
    float strength = 2;           ///< standard errors up to which a difference counts as noise
    float least_validity = 0.5f;  ///< texels below it are neither used nor changed
    StopFlag stop = {};
};
void denoise(std::span<LightmapPage> pages, const PageChannels& channels, const Guides& guides,
             std::span<const double> integrals, double domain_solid_angle, const DenoiseOptions& options = {});

/// Converts pages of the coefficients that `basis` is fitted from to pages of its own coefficients, texel by texel,
/// including empty ones. The last step.
[[nodiscard]] std::vector<LightmapPage> fit_pages(std::span<const LightmapPage> pages, const FittedBasis& basis,
                                                  StopFlag stop = {});

/// Fills texels that were not baked, or whose validity is below `least_validity`, from their nearest valid neighbours
/// within `radius` texels, of the same chart first; so that filtering and mips use valid values. `chart` is unchanged.
struct DilateOptions {
    std::size_t radius = 4;
    float least_validity = 0.5f;
    StopFlag stop = {};
};
void dilate(std::span<LightmapPage> pages, const DilateOptions& options = {});

}  // namespace lobelia
