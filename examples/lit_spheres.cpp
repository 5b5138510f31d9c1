// Diffuse spheres under an environment: lit exactly, and from the coefficients of a few codecs, side by side as a PNG.
//
//   lit_spheres OUT.png [ENVIRONMENT]    a latitude-longitude .hdr or .exr in place of the embedded sky
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "io/read_image.h"
#include "io/write_image.h"
#include "lobelia/lobelia.h"

namespace {

using namespace lobelia;

constexpr std::size_t k_side = 200;  // Pixels along a sphere's square.

/// A sphere seen from +z, which fills 94 % of its square: its pixels, and the normal at each.
struct Sphere {
    std::vector<std::size_t> pixels;
    Directions normals;
};

Sphere make_sphere() {
    std::vector<std::size_t> pixels;
    std::vector<Vec3> normals;
    const auto position = [](std::size_t i) { return (2 * (static_cast<float>(i) + 0.5f) / k_side - 1) / 0.94f; };
    for (std::size_t i = 0; i < k_side * k_side; ++i) {
        const float x = position(i % k_side), y = -position(i / k_side), r2 = x * x + y * y;
        if (r2 >= 1) continue;
        pixels.push_back(i);
        normals.push_back({x, y, std::sqrt(1 - r2)});
    }
    Sphere sphere{std::move(pixels), Directions(normals.size())};
    for (std::size_t i = 0; i < normals.size(); ++i) set_entry(sphere.normals, i, normals[i]);
    return sphere;
}

/// Draws a white diffuse sphere, which reflects E / pi, into a column of the picture.
void draw(const Sphere& sphere, const Colours& irradiance, std::size_t column, Image& picture) {
    for (std::size_t i = 0; i < sphere.pixels.size(); ++i) {
        const Rgb E = colour_at(irradiance, i);
        const auto reflected = [](float channel) { return static_cast<float>(channel / k_pi); };
        picture.at(column * k_side + sphere.pixels[i] % k_side, sphere.pixels[i] / k_side) = {
            reflected(E.r), reflected(E.g), reflected(E.b)};
    }
}

float mean(const Colours& colours) {
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < colours.size(); ++i) sum += colours.channel(c)[i];
    return static_cast<float>(sum / (3.0 * static_cast<double>(colours.size())));
}

Status run(const std::string& out, const std::string& environment) {
    // Take samples: every texel once.
    Image image = sky({256, 128});
    if (environment != "sky") {
        auto loaded = read_environment(environment);
        if (!loaded) return loaded.error();
        image = std::move(loaded->image);
    }
    const Samples samples = texel_samples(image);

    // Light a sphere exactly.
    const Sphere sphere = make_sphere();
    Colours exact(sphere.pixels.size()), decoded(sphere.pixels.size());
    irradiance_sum(samples, sphere.normals, exact);
    const float mean_irradiance = mean(exact);
    const std::vector<std::string> codecs{"ambient-cube-e/moments/squares", "sh1/projection/convolution",
                                          "sh2/projection/convolution", "sg12/least-squares/exact"};
    Image picture((codecs.size() + 1) * k_side, k_side);
    draw(sphere, exact, 0, picture);

    // Light one from the coefficients of each codec, and measure its error.
    std::printf("From the left: exact\n");
    const std::vector<float> equal(sphere.pixels.size(), 1.0f);
    for (std::size_t k = 0; k < codecs.size(); ++k) {
        const Codec codec = make_codec(codecs[k]).value();
        const auto coefficients = codec.encode(samples);
        codec.irradiance(coefficients, sphere.normals, decoded);
        draw(sphere, decoded, k + 1, picture);
        std::printf("               %s: %zu colours, error %.1f %% of the mean\n", codecs[k].c_str(),
                    coefficients.size(), 100 * errors(decoded, exact, equal).rms / mean_irradiance);
    }

    // Expose for the mean irradiance.
    return write_png(out, to_srgb(picture, static_cast<float>(0.4 * k_pi) / mean_irradiance));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2 || argc > 3) {
        std::fprintf(stderr, "usage: lit_spheres OUT.png [ENVIRONMENT]\n");
        return 2;
    }
    const Status status = run(argv[1], argc == 3 ? argv[2] : "sky");
    if (!status) std::fprintf(stderr, "lit_spheres: %s\n", status.error().message.c_str());
    return status ? 0 : 2;
}
