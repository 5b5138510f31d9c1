// Checks that all image readers share: limits on the size, and NaN, infinite or negative pixels.
#include "io/image_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

namespace lobelia::io {

namespace {

/// Sums of squares of larger values would overflow float32; the sun has 1e7 W/(m^2 sr).
constexpr float k_most_radiance = 1e15f;

enum class Fault { none, nan, infinite, negative };

Fault fault_of(Rgb pixel) {
    const std::array<float, 3> components{pixel.r, pixel.g, pixel.b};
    Fault fault = Fault::none;
    for (const float c : components) {
        if (std::isnan(c)) return Fault::nan;
        if (c > k_most_radiance || c < -k_most_radiance) fault = Fault::infinite;
        if (c < 0 && fault == Fault::none) fault = Fault::negative;
    }
    return fault;
}

Rgb sanitized(Rgb pixel) {
    const auto clean = [](float c) { return c > 0 && c <= k_most_radiance ? c : 0.0f; };
    return {clean(pixel.r), clean(pixel.g), clean(pixel.b)};
}

void count(BadPixels& bad, Fault fault) {
    bad.nan += fault == Fault::nan;
    bad.infinite += fault == Fault::infinite;
    bad.negative += fault == Fault::negative;
}

}  // namespace

Status check_size(std::string_view name, std::int64_t width, std::int64_t height, const ReadOptions& options) {
    if (width <= 0 || height <= 0)
        return Error{fmt::format("{}: the image is {} x {} pixels; it must have at least one", name, width, height)};
    if (width > k_most_side || height > k_most_side)
        return Error{
            fmt::format("{}: the image is {} x {} pixels; no side may exceed {}", name, width, height, k_most_side)};
    if (static_cast<std::uint64_t>(width * height) > options.most_pixels)
        return Error{fmt::format("{}: the image is {} x {} pixels; at most {} pixels are read", name, width, height,
                                 options.most_pixels)};
    return Done{};
}

void clip_negatives(LoadedImage& loaded, std::string_view cause) {
    // Find the largest component: rounding is small compared with it, and more than that is a fault of the file.
    float largest = 0;
    for (const Rgb& pixel : loaded.image.pixels) largest = std::max({largest, pixel.r, pixel.g, pixel.b});
    std::size_t clipped = 0;
    for (Rgb& pixel : loaded.image.pixels) {
        if (fault_of(pixel) != Fault::negative || std::min({pixel.r, pixel.g, pixel.b}) < -0.01f * largest) continue;
        pixel = sanitized(pixel);
        ++clipped;
    }
    if (clipped > 0)
        loaded.warnings.push_back(
            fmt::format("the negative components of {} pixels were set to 0: {}", clipped, cause));
}

Status check_pixels(LoadedImage& loaded, std::string_view name, const ReadOptions& options) {
    // Count invalid pixels, and replace their invalid components if allowed.
    BadPixels bad;
    std::optional<std::size_t> first;
    for (std::size_t i = 0; i < loaded.image.pixels.size(); ++i) {
        Rgb& pixel = loaded.image.pixels[i];
        const Fault fault = fault_of(pixel);
        if (fault == Fault::none) continue;
        count(bad, fault);
        if (!first) first = i;
        if (options.sanitize) pixel = sanitized(pixel);
    }
    if (!first) return Done{};

    // Refuse the image with the first place, or report the replacements.
    if (!options.sanitize)
        return Error{fmt::format(
            "{}: {} NaN, {} infinite (or above 1e15) and {} negative pixels, the first at x = {}, y = {}; pass "
            "--sanitize to replace them by 0",
            name, bad.nan, bad.infinite, bad.negative, *first % loaded.image.width, *first / loaded.image.width)};
    loaded.sanitized = bad;
    loaded.warnings.push_back(fmt::format("{} NaN, {} infinite and {} negative pixels were replaced by 0", bad.nan,
                                          bad.infinite, bad.negative));
    return Done{};
}

void warn_of_shape(LoadedImage& loaded) {
    const std::size_t width = loaded.image.width, height = loaded.image.height;
    if (width != 2 * height)
        loaded.warnings.push_back(fmt::format(
            "the image is {} x {} pixels, not 2 : 1; it is stretched over the whole sphere", width, height));
}

Result<LoadedImage> inspected(LoadedImage loaded, std::string_view name, const ReadOptions& options) {
    if (const Status status = check_pixels(loaded, name, options); !status) return status.error();
    warn_of_shape(loaded);
    return loaded;
}

}  // namespace lobelia::io
