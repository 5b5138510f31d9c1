// Checks that all image readers share: limits on the size, and NaN, infinite or negative pixels.
#pragma once

#include <cstdint>

#include "io/read_image.h"

namespace lobelia::io {

/// Largest width and height of an image that is read or written.
inline constexpr std::int64_t k_most_side = 65536;

/// Returns an error for a size that is 0, negative, or above a limit.
[[nodiscard]] Status check_size(std::string_view name, std::int64_t width, std::int64_t height,
                                const ReadOptions& options);

/// Sets negative components to 0 if they are small compared with the largest component (1 %), with a warning that names
/// `cause`: for values that arise in decoding valid files.
void clip_negatives(LoadedImage& loaded, std::string_view cause);

/// Counts pixels that are NaN, infinite or negative: an error, or replaced by 0 with a warning if options.sanitize.
[[nodiscard]] Status check_pixels(LoadedImage& loaded, std::string_view name, const ReadOptions& options);

/// Adds a warning if the image is not twice as wide as high, as a latitude-longitude map is.
void warn_of_shape(LoadedImage& loaded);

/// check_pixels, then warn_of_shape.
[[nodiscard]] Result<LoadedImage> inspected(LoadedImage loaded, std::string_view name, const ReadOptions& options);

}  // namespace lobelia::io
