// Checks the contract of every image that a reader returns, for any input bytes.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string_view>

#include "io/read_image.h"

namespace lobelia {

/// Small limits: a hostile file may cost no more than a few megabytes and milliseconds.
inline constexpr ReadOptions k_fuzz_options{.ldr = true, .sanitize = true, .most_pixels = 1 << 16};

inline void require(bool holds) {
    if (!holds) std::abort();
}

/// The input as bytes and as text.
inline std::span<const std::byte> bytes_of(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const std::byte*>(data), size};
}
inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

/// Requires a result, or an error that says something.
template <class T>
bool check_result(const Result<T>& result) {
    if (!result) require(!result.error().message.empty());
    return static_cast<bool>(result);
}

inline void check_loaded(const Result<LoadedImage>& loaded) {
    if (!check_result(loaded)) return;
    const Image& image = loaded->image;
    require(image.width > 0 && image.height > 0 && image.pixels.size() == image.width * image.height);
    require(image.pixels.size() <= k_fuzz_options.most_pixels);
    for (const Rgb& p : image.pixels) {
        require(std::isfinite(p.r) && std::isfinite(p.g) && std::isfinite(p.b));
        require(p.r >= 0 && p.g >= 0 && p.b >= 0);
    }
}

}  // namespace lobelia
