// Ranges of a job's options: the one list of them, for the command line, other languages, job files and bake() itself.
#pragma once

#include "lobelia/bake_job.h"

namespace lobelia {

/// The values that an option may have, both ends included.
struct OptionRange {
    double low, high;
};

namespace ranges {
inline constexpr OptionRange side{1, 16384};  ///< of a page or a picture
inline constexpr OptionRange texels_per_metre{0.01, 10000};
inline constexpr OptionRange padding{0, 64};
inline constexpr OptionRange samples{1, 1'000'000};
inline constexpr OptionRange samples_per_pass{16, 4096};
inline constexpr OptionRange bounces{0, 64};
inline constexpr OptionRange threads{0, 1024};
inline constexpr OptionRange memory{64 << 20, 1e15};  ///< [bytes]
inline constexpr OptionRange seconds{0.1, 1e7};       ///< the time limit
inline constexpr OptionRange target_error{1e-4, 1};
inline constexpr OptionRange shards{1, 65536};
inline constexpr OptionRange probe_spacing{0.001, 10000};  ///< [m]
inline constexpr OptionRange probe_levels{0, 6};
inline constexpr OptionRange probe_tolerance{0, 1e6};
inline constexpr OptionRange probe_samples{64, 1'000'000};
inline constexpr OptionRange probe_visibility{0, 32};    ///< [texels]
inline constexpr OptionRange picture_samples{1, 65536};  ///< per pixel
inline constexpr OptionRange uv_set{0, 7};
inline constexpr OptionRange mip_levels{1, 15};
}  // namespace ranges

/// An error that names the first option outside its range. bake() itself checks what depends on the scene or the codec.
[[nodiscard]] Status check(const BakeJob& job);

}  // namespace lobelia
