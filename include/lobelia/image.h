// An image of linear floats in memory, exchanged between files, environments and pictures.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lobelia/math.h"

namespace lobelia {

/// Floats of 16 or 32 bits.
enum class Precision { half, full };

/// `width` x `height` linear Rec. 709 pixels, row by row from the top left.
struct Image {
    std::size_t width = 0;
    std::size_t height = 0;
    std::vector<Rgb> pixels;

    Image() = default;
    Image(std::size_t w, std::size_t h) : width(w), height(h), pixels(w * h) {}
    [[nodiscard]] Rgb& at(std::size_t x, std::size_t y) { return pixels[y * width + x]; }
    [[nodiscard]] const Rgb& at(std::size_t x, std::size_t y) const { return pixels[y * width + x]; }
};

}  // namespace lobelia
