// Checks the contract of every image that a reader returns, for any input bytes.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "io/read_image.h"

namespace lobelia {

/// Small limits: a hostile file may cost no more than a few megabytes and milliseconds.
inline constexpr ReadOptions k_fuzz_options{.ldr = true, .sanitize = true, .most_pixels = 1 << 16};

inline void require(bool holds) {
    if (!holds) std::abort();
}

inline void check_loaded(const Result<LoadedImage>& loaded) {
    if (!loaded) {
        require(!loaded.error().message.empty());
        return;
    }
    const Image& image = loaded->image;
    require(image.width > 0 && image.height > 0 && image.pixels.size() == image.width * image.height);
    require(image.pixels.size() <= k_fuzz_options.most_pixels);
    for (const Rgb& p : image.pixels) {
        require(std::isfinite(p.r) && std::isfinite(p.g) && std::isfinite(p.b));
        require(p.r >= 0 && p.g >= 0 && p.b >= 0);
    }
}

}  // namespace lobelia
