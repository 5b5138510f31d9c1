// A bake's options: what is baked, how it is finished, and in which form it is stored.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lobelia/codec.h"
#include "lobelia/render.h"
#include "lobelia/scene_source.h"

namespace lobelia {

/// Coordinate frame of spherical coefficients; hemispherical bases always use the tangent frame.
enum class Frame { tangent, world };

/// Distribution of first directions. uniform: best for the moments of radiance. mixture: half uniform, half
/// proportional to the cosine (hemisphere only); best for irradiance at the normal.
enum class DirectionChoice { uniform, mixture };

struct AtlasOptions {
    std::size_t width = 512, height = 512;        ///< page size [texels], at most 16384 each
    std::optional<double> texels_per_metre = {};  ///< sizes objects by their area; selects the packed layout
    std::size_t padding = 2;                      ///< texels between packed objects
    /// shared: all objects lie in one UV square without overlaps, as unwrappers of whole scenes leave them. packed:
    /// each object has a UV square of its own; the part that it uses is packed into pages, at texels_per_metre or,
    /// without it, as large as fits on one page. automatic: shared if no two objects overlap and texels_per_metre is
    /// absent.
    enum class Layout { automatic, shared, packed } layout = Layout::automatic;
};

/// One part of a bake that several machines share: part `index` of `count`.
struct Shard {
    enum class By { tiles, samples } by = By::tiles;
    std::uint32_t index = 0, count = 1;
    friend bool operator==(const Shard&, const Shard&) = default;
};

struct BakeOptions {
    std::string codec = default_codec();  ///< basis/encoder/evaluator; empty: irradiance at the shading normal only
    Frame frame = Frame::world;
    AtlasOptions atlas;
    PathOptions paths;
    DirectionChoice directions = DirectionChoice::uniform;
    Switch push_out = Switch::on;               ///< move sample points out of overlapping geometry
    std::uint32_t samples = 256;                ///< per texel; rounded up to whole passes
    std::uint32_t samples_per_pass = 16;        ///< a multiple of k_lanes
    std::optional<double> most_seconds;         ///< stop after the first pass that exceeds this time
    std::optional<double> target_error;         ///< a texel is done when its relative standard error of E is smaller
    std::size_t memory = std::size_t{2} << 30;  ///< budget for states and pages [bytes]; larger bakes run in regions
    unsigned threads = 0;                       ///< 0: one per processor
    Shard shard;
    std::optional<std::string> only_object;  ///< bake the texels of this object only
};

/// Steps after the bake, in this order.
struct FinishOptions {
    Switch denoise = Switch::on;
    Switch seams = Switch::on;
    Switch dilate = Switch::on;
};

struct ProbeOptions {
    double spacing = 1;                      ///< coarsest grid [m]
    std::optional<std::array<Vec3, 2>> box;  ///< lowest and highest corner; absent: the box around the scene
    std::string codec = default_codec();     ///< must be spherical
    int levels = 0;                          ///< maximum number of subdivisions of a cell into eight
    double tolerance = 0.15;                 ///< divide a cell if the irradiance in its middle is off by this fraction
    std::uint32_t samples = 1024;            ///< per probe
    std::size_t most_probes = 1u << 20;      ///< more are an error
    std::uint32_t visibility = 8;            ///< side of the octahedral maps of distance [texels]; 0: none
};

/// The textures of the pages' coefficients, and of their validity.
struct TextureOptions {
    std::optional<std::vector<std::string>> storages = {};  ///< by name; absent: default_storages()
    std::string container = "ktx2";                         ///< file format, and the extension
    /// on: textures of one pixel format and size are the layers of one array texture; off: each is a file.
    Switch arrays = Switch::on;
    /// Mip levels, the page itself included: each texel of a smaller one is the mean of the valid texels of one chart
    /// among the four above it. The page's sides must be multiples of 2^(levels - 1).
    std::uint32_t levels = 1;
    Switch zstd = Switch::off;  ///< compresses the files, where the container can
};

/// The HTML report, made after the bake; kept with the job, so that a resumed bake makes the same one.
struct ReportOptions {
    Switch write = Switch::on;
    std::uint32_t samples = 64;             ///< per pixel of its pictures
    std::size_t width = 640, height = 400;  ///< of its pictures
};

/// All that decides a bake's result.
struct BakeJob {
    /// Kept with checkpoints, so that a bake can be resumed without repeating it; bake() does not read it.
    SceneSource scene;
    BakeOptions bake;
    FinishOptions finish;
    std::optional<ProbeOptions> probes;     ///< absent: no probes
    Precision precision = Precision::half;  ///< of the pages; full where half cannot hold their values
    TextureOptions textures;
    std::optional<std::vector<std::string>> exports;  ///< plain lightmaps besides, by name; absent: none
    ReportOptions report;
};

}  // namespace lobelia
