// What every image reader shares: the limits on size, and the inspection of decoded pixels.
#pragma once

#include <cstdint>

#include "io/read_image.h"

namespace lobelia::io {

/// No image is wider or higher than this.
inline constexpr std::int64_t k_most_side = 65536;

/// An error for a size that is 0, negative, or above a limit.
[[nodiscard]] Status check_size(std::string_view name, std::int64_t width, std::int64_t height,
                                const ReadOptions& options);

/// Sets negative components to 0 where they are small beside the largest (1 %), and says so in a warning that gives
/// `cause`: for those that arise in decoding valid files, and are not faults of theirs.
void clip_negatives(LoadedImage& loaded, std::string_view cause);

/// Counts, and replaces where `options.sanitize` says so, components that are no radiance; warns of an odd aspect.
[[nodiscard]] Result<LoadedImage> inspected(LoadedImage loaded, std::string_view name, const ReadOptions& options);

}  // namespace lobelia::io
