// The attribute envmap of OpenEXR: how an environment is laid out in its image.
#pragma once

#include <OpenEXR/ImfHeader.h>

#include "io/read_image.h"

namespace lobelia::io {

/// Converts an image to Lobelia's latitude-longitude map (docs/conventions.md) according to the attribute envmap of
/// `header`. Without the attribute, returns the image as it is. A latitude-longitude map of OpenEXR, whose centre looks
/// along +z, is turned by half its width. A cube of six N x N faces becomes 4 N x 2 N texels, each the mean of the cube
/// over it; an error if it is not six times as high as wide, or too large.
[[nodiscard]] Result<LoadedImage> to_latitude_longitude(LoadedImage loaded, const Imf::Header& header,
                                                        std::string_view name, const ReadOptions& options);

}  // namespace lobelia::io
