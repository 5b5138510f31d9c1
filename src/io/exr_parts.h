// What the readers of OpenEXR files ask about a part before they allocate for it.
#pragma once

#include <OpenEXR/ImfHeader.h>

#include "io/read_image.h"

namespace lobelia::io {

struct ExrSize {
    std::int64_t width = 0, height = 0;
};
[[nodiscard]] ExrSize size_of(const Imf::Header& header);

[[nodiscard]] bool is_deep(const Imf::Header& header);

/// An error where OpenEXR would buffer more than is fit for an image of at most options.most_pixels, where the image is
/// larger than that, or where `file_bytes` cannot hold `channels` channels of its size, however well compressed.
[[nodiscard]] Status check_part(const Imf::Header& header, std::string_view name, std::uint64_t file_bytes,
                                std::uint64_t channels, const ReadOptions& options);

/// An error where channel `channel`, if there is one, is not sampled at 1 / `rate` in both directions.
[[nodiscard]] Status check_sampling(const Imf::Header& header, const std::string& channel, std::string_view name,
                                    int rate);

}  // namespace lobelia::io
