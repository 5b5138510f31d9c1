// The finishing steps, on pages of coefficients: seams, denoising, dilation. Each works in coefficient space, channel
// by channel, and knows no basis. Order: denoise, seams, dilate. Results do not depend on the number of threads. Each
// step that is given a StopFlag throws Stopped once it is set, and leaves the pages half done.
#pragma once

#include "bake/place/atlas.h"
#include "bake/place/texels.h"
#include "lobelia/basis.h"
#include "lobelia/lightmap.h"

namespace lobelia {

/// Positions and smooth normals of the covered texels, page by page, row by row; what guides the denoiser.
struct Guides {
    std::vector<std::vector<Vec3>> position, normal;
};
/// Positions and normals as make_receivers gives them.
[[nodiscard]] Guides make_guides(const Atlas& atlas, const TexelMap& map, StopFlag stop = {});

/// Makes the two sides of each seam agree: where an edge of a triangle, or the part of it along a shorter edge, lies in
/// two places on the pages (of one object or of two that touch), the bilinearly filtered values along both, as they are
/// after `dilate`. Least squares over the texels near seams: |difference along the seam|^2 + weight |change|^2, one
/// sparse system (Eigen) for each channel of all pages. Each texel stays within the range of the texels that its seams
/// read, so that light that was never negative stays so. Positions within `tolerance` [m] and normals within about 10
/// degrees count as the same edge.
struct SeamOptions {
    float weight = 0.05f;
    float tolerance = 1e-4f;
    float least_validity = 0.5f;  ///< as for `dilate`, which will replace texels below it
    StopFlag stop = {};
};
struct SeamReport {
    std::size_t edges = 0;         ///< pairs, of edges or of parts, that were joined
    double before = 0, after = 0;  ///< RMS difference of the irradiance channels along them
};
/// What must not be mixed: seams stay open where a surface stands on them, and texels whose light was not measured
/// where they lie take no part.
struct SeamSurroundings {
    const PathTracer* tracer = nullptr;                ///< null: nothing stands on seams
    std::vector<std::vector<std::uint8_t>> displaced;  ///< as displaced_texels gives it; empty: none
};
SeamReport close_seams(std::span<LightmapPage> pages, const PageChannels& channels, const Atlas& atlas,
                       const SeamOptions& options = {}, const SeamSurroundings& around = {});

/// Smooths noise within each chart, never across charts: an edge-avoiding filter guided by position and normal and
/// scaled by the standard error that the bake measured. Coefficients are divided by the texel's mean radiance (sum of
/// c_i times `integrals`, over the domain's solid angle) before filtering and multiplied by its filtered value after,
/// so that directions are not smeared by brightness (for SH: L1 / L0).
struct DenoiseOptions {
    int passes = 4;               ///< a-trous levels, 1 to 6
    float strength = 2;           ///< how many standard errors of a difference count as noise
    float least_validity = 0.5f;  ///< texels below it are neither read nor changed
    StopFlag stop = {};
};
void denoise(std::span<LightmapPage> pages, const PageChannels& channels, const Guides& guides,
             std::span<const double> integrals, double domain_solid_angle, const DenoiseOptions& options = {});

/// From pages of what `basis` is fitted from to pages of its own coefficients, texel by texel, empty ones, too. The
/// last step.
[[nodiscard]] std::vector<LightmapPage> fit_pages(std::span<const LightmapPage> pages, const FittedBasis& basis,
                                                  StopFlag stop = {});

/// Fills texels where nothing was baked, or whose validity is below `least_validity`, from their nearest valid
/// neighbours within `radius` texels, of the same chart first; so that filtering and mips read no rubbish. `chart`
/// stays as it was.
struct DilateOptions {
    std::size_t radius = 4;
    float least_validity = 0.5f;
    StopFlag stop = {};
};
void dilate(std::span<LightmapPage> pages, const DilateOptions& options = {});

}  // namespace lobelia
