// Data window and display window of OpenEXR: where the stored pixels lie in the image.
#pragma once

#include <OpenEXR/ImfHeader.h>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lobelia::io {

/// A rectangle of pixels, its right and lower ends excluded.
struct ExrWindow {
    std::int64_t left = 0, top = 0, right = 0, bottom = 0;
    bool operator==(const ExrWindow&) const = default;
    [[nodiscard]] std::int64_t width() const { return right - left; }
    [[nodiscard]] std::int64_t height() const { return bottom - top; }
    [[nodiscard]] std::size_t pixels() const { return static_cast<std::size_t>(width() * height()); }
};

/// The pixels that are stored.
[[nodiscard]] ExrWindow data_window(const Imf::Header& header);
/// The image; pixels of it that are not stored are black.
[[nodiscard]] ExrWindow display_window(const Imf::Header& header);
/// Returns the intersection; empty (a side of 0 or less) if they do not overlap.
[[nodiscard]] ExrWindow common_window(const ExrWindow& a, const ExrWindow& b);
/// Warns of windows that differ; no text if they do not.
[[nodiscard]] std::vector<std::string> warnings_about_windows(const Imf::Header& header);

/// Moves pixels stored row by row over the data window to the display window, where the others are zero.
template <class Pixel>
[[nodiscard]] std::vector<Pixel> placed(std::vector<Pixel> stored, const ExrWindow& data, const ExrWindow& display) {
    assert(stored.size() == data.pixels());
    if (data == display) return stored;
    std::vector<Pixel> image(display.pixels());
    const ExrWindow common = common_window(data, display);
    for (std::int64_t y = common.top; y < common.bottom; ++y)
        std::copy_n(stored.begin() + (y - data.top) * data.width() + (common.left - data.left), common.width(),
                    image.begin() + (y - display.top) * display.width() + (common.left - display.left));
    return image;
}

}  // namespace lobelia::io
