// The attribute envmap of OpenEXR, after the comments of ImfEnvmap.h. Both frames are right-handed with y up.
#include "io/exr_envmap.h"

#include <OpenEXR/ImfEnvmap.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/image_checks.h"

namespace lobelia::io {

namespace {

/// A cube map: six faces of OpenEXR, one below the other.
class Cube {
  public:
    explicit Cube(const Image& image)
        : image_(image), window_({0, 0}, {static_cast<int>(image.width) - 1, static_cast<int>(image.height) - 1}) {}

    /// Returns the radiance from `direction`, which need not be normalised, without interpolation.
    [[nodiscard]] Rgb at(const Imath::V3f& direction) const {
        Imf::CubeMapFace face{};
        Imath::V2f in_face;
        Imf::CubeMap::faceAndPixelPosition(direction, window_, face, in_face);
        const Imath::V2f position = Imf::CubeMap::pixelPosition(face, window_, in_face);
        return image_.at(index(position.x, image_.width), index(position.y, image_.height));
    }

  private:
    static std::size_t index(float position, std::size_t size) {
        return static_cast<std::size_t>(std::clamp(std::round(position), 0.0f, static_cast<float>(size - 1)));
    }

    const Image& image_;
    Imath::Box2i window_;
};

/// Sines and cosines of angles at the middles of `count` equal steps from `begin` over `range`.
struct Angles {
    Angles(std::size_t count, double begin, double range) : sine(count), cosine(count) {
        for (std::size_t i = 0; i < count; ++i) {
            const double angle = begin + range * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
            sine[i] = static_cast<float>(std::sin(angle));
            cosine[i] = static_cast<float>(std::cos(angle));
        }
    }
    std::vector<float> sine, cosine;
};

/// Averages the cube over each texel with k x k directions, weighted by solid angle.
Image map_of(const Cube& cube, std::size_t face) {
    const std::size_t k = std::clamp<std::size_t>(2048 / face, 4, 16);
    Image map(4 * face, 2 * face);
    const Angles theta(k * map.width, -std::numbers::pi, 2 * std::numbers::pi);
    const Angles phi(k * map.height, 0, std::numbers::pi);
    for (std::size_t y = 0; y < map.height; ++y)
        for (std::size_t x = 0; x < map.width; ++x) {
            Rgb sum;
            float weights = 0;
            for (std::size_t j = k * y; j < k * (y + 1); ++j) {
                Rgb row;
                for (std::size_t i = k * x; i < k * (x + 1); ++i)
                    row = row + cube.at({phi.sine[j] * theta.sine[i], phi.cosine[j], -phi.sine[j] * theta.cosine[i]});
                sum = sum + row * phi.sine[j];
                weights += phi.sine[j] * static_cast<float>(k);
            }
            map.at(x, y) = sum * (1 / weights);
        }
    return map;
}

Result<LoadedImage> from_cube(LoadedImage loaded, std::string_view name, const ReadOptions& options) {
    const Image& image = loaded.image;
    const std::size_t face = image.width;
    if (image.height != 6 * face)
        return Error{fmt::format(
            "{}: the attribute envmap says that it is a cube, but {} x {} pixels are not six square faces one below "
            "the other",
            name, image.width, image.height)};
    const auto side = static_cast<std::int64_t>(face);
    if (const Status status = check_size(name, 4 * side, 2 * side, options); !status) return status.error();
    loaded.warnings.push_back(
        fmt::format("a cube of {0} x {0} pixels was converted to {1} x {2} texels", face, 4 * face, 2 * face));
    loaded.image = map_of(Cube(image), face);
    return loaded;
}

LoadedImage turned_round(LoadedImage loaded) {
    Image& image = loaded.image;
    const auto width = static_cast<std::ptrdiff_t>(image.width);
    for (auto row = image.pixels.begin(); row != image.pixels.end(); row += width)
        std::rotate(row, row + width / 2, row + width);
    loaded.warnings.emplace_back(
        "the attribute envmap says that the centre looks along +z; the image was turned by half its width, as -z is "
        "at the centre here");
    return loaded;
}

}  // namespace

Result<LoadedImage> to_latitude_longitude(LoadedImage loaded, const Imf::Header& header, std::string_view name,
                                          const ReadOptions& options) {
    if (!Imf::hasEnvmap(header)) return loaded;
    switch (Imf::envmap(header)) {
        case Imf::ENVMAP_LATLONG:
            return turned_round(std::move(loaded));
        case Imf::ENVMAP_CUBE:
            return from_cube(std::move(loaded), name, options);
        default:
            return Error{fmt::format("{}: attribute envmap: {} is neither 0 (latitude-longitude) nor 1 (cube)", name,
                                     static_cast<int>(Imf::envmap(header)))};
    }
}

}  // namespace lobelia::io
