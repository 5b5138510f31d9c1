// The bake: passes of samples into one encoder state for each texel, progressive, resumable, the same at any number of
// threads; then coefficients on pages.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>

#include "baker/atlas.h"
#include "baker/finish.h"
#include "baker/gather.h"
#include "baker/pages.h"
#include "lobelia/codec.h"
#include "lobelia/result.h"

namespace lobelia {

/// In which frame a basis over the sphere stands at a texel; hemispheres always stand in the tangent frame.
enum class Frame { tangent, world };

/// One part of a bake that several machines share: part `index` of `count`.
struct Shard {
    enum class By { tiles, samples } by = By::tiles;
    std::uint32_t index = 0, count = 1;
};

struct BakeOptions {
    std::string codec = "sh1/moments/convolution";
    Frame frame = Frame::world;
    AtlasOptions atlas;
    PathOptions paths;
    DirectionChoice directions = DirectionChoice::uniform;
    Switch push_out = Switch::on;
    std::uint32_t samples = 256;                ///< for each texel; rounded up to whole passes
    std::uint32_t samples_per_pass = 16;        ///< a multiple of 16
    std::optional<double> most_seconds;         ///< end after the pass that reaches it
    std::optional<double> target_error;         ///< a texel is done when its relative standard error of E is below this
    std::size_t memory = std::size_t{2} << 30;  ///< bytes for states and pages
    unsigned threads = 0;                       ///< 0: all processors
    Shard shard;
    std::optional<std::string> only_object;  ///< bake this object's texels alone
    std::filesystem::path checkpoint;        ///< empty: none
};

/// What is known while it runs and after.
struct BakeStatistics {
    std::size_t texels = 0;          ///< covered
    std::size_t invalid_texels = 0;  ///< validity below one half
    std::uint64_t rays = 0;
    double seconds = 0;            ///< tracing and encoding, over all sessions
    std::uint32_t samples = 0;     ///< of each texel, at most
    double mean_error = 0;         ///< RMS over texels of the standard error of E's luminance over the mean E
    std::uint64_t back_faces = 0;  ///< paths that met a back face first: leaks
    double negative_share = 0;     ///< of coefficient-reconstructed irradiance over the hemisphere about the normal
    double ringing = 0;            ///< mean of the negative part over the mean irradiance
};

}  // namespace lobelia
