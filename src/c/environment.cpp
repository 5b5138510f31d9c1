// Environments: from files, from the sky model, from the caller's pixels.
#include <cmath>

#include "c/handles.h"
#include "io/read_image.h"

using namespace lobelia;
using namespace lobelia::c;

namespace {

/// Largest width or height: what LatLong can index, with room to spare.
constexpr std::size_t k_most_side = 65536;

lob_status check_grid(const char* function, std::size_t width, std::size_t height) {
    if (width >= 1 && height >= 1 && width <= k_most_side && height <= k_most_side) return LOB_OK;
    return fail(LOB_BAD_INPUT, std::string(function) + ": width and height must be in 1 to 65536");
}

}  // namespace

lob_status lob_environment_load(const char* path, lob_environment** out) {
    return guarded([&] {
        if (auto status = check_pointers("lob_environment_load", path, out)) return status;
        auto loaded = read_environment(std::filesystem::path(path));
        if (!loaded) return fail(LOB_BAD_INPUT, loaded.error().message);
        *out = new lob_environment{std::move(loaded->image)};
        return LOB_OK;
    });
}

lob_status lob_environment_sky(size_t width, size_t height, double turbidity, double sun_elevation, double sun_azimuth,
                               lob_environment** out) {
    return guarded([&] {
        if (auto status = check_pointers("lob_environment_sky", out)) return status;
        if (auto status = check_grid("lob_environment_sky", width, height)) return status;
        SkyOptions options;
        options.turbidity = turbidity;
        options.sun_elevation = sun_elevation;
        options.sun_azimuth = sun_azimuth;
        if (const auto valid = check(options); !valid) return fail(LOB_BAD_INPUT, valid.error().message);
        *out = new lob_environment{sky({width, height}, options)};
        return LOB_OK;
    });
}

lob_status lob_environment_from_pixels(const float* pixels, size_t width, size_t height, lob_environment** out) {
    return guarded([&] {
        if (auto status = check_pointers("lob_environment_from_pixels", pixels, out)) return status;
        if (auto status = check_grid("lob_environment_from_pixels", width, height)) return status;
        for (std::size_t i = 0; i < 3 * width * height; ++i)
            if (!(pixels[i] >= 0 && std::isfinite(pixels[i])))
                return fail(LOB_BAD_INPUT, "lob_environment_from_pixels: pixel " + std::to_string(i / 3) +
                                               " is NaN, infinite or negative");
        std::unique_ptr<lob_environment> environment(new lob_environment{Image(width, height)});
        const auto from = colours(pixels, width * height);
        environment->image.pixels.assign(from.begin(), from.end());
        *out = environment.release();
        return LOB_OK;
    });
}

size_t lob_environment_width(const lob_environment* environment) {
    return environment == nullptr ? 0 : environment->image.width;
}

size_t lob_environment_height(const lob_environment* environment) {
    return environment == nullptr ? 0 : environment->image.height;
}

const float* lob_environment_pixels(const lob_environment* environment) {
    return environment == nullptr ? nullptr : &environment->image.pixels.data()->r;
}

void lob_environment_free(lob_environment* environment) { delete environment; }
