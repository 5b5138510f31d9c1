// Plain lightmaps, and THE list of them.
#include "bake/write/lightmap_exports.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "io/texture/container.h"
#include "io/write_image.h"

namespace lobelia {
namespace {

constexpr std::array k_exports = {
    LightmapExport{"rgb", "irradiance E [W/m^2]", 1},
    LightmapExport{"rgb-over-pi", "irradiance over pi: what a white Lambertian surface reflects [W/(m^2 sr)]",
                   1 / k_pi},
    LightmapExport{"moz-lightmap",
                   "the same inside scene.glb, as 8-bit textures of the materials' extension MOZ_lightmap", 1 / k_pi,
                   LightmapExport::Place::scene},
};

/// Red, green and blue of irradiance times a factor, at least 0.
std::array<std::vector<float>, 3> irradiance_of(const LightmapPage& page, const PageChannels& channels, double factor) {
    std::array<std::vector<float>, 3> rgb;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto& plane = page.planes[channels.irradiance(k)];
        rgb[k].resize(page.size());
        std::transform(plane.begin(), plane.end(), rgb[k].begin(),
                       [&](float e) { return static_cast<float>(std::max(0.0, factor * static_cast<double>(e))); });
    }
    return rgb;
}

float largest_of(const std::array<std::vector<float>, 3>& rgb) {
    float largest = 0;
    for (const auto& plane : rgb) largest = std::max(largest, largest_magnitude(plane.data(), plane.size()));
    return largest;
}

Status write_texture_of(StagedFile& file, const LightmapPage& page, const std::array<std::vector<float>, 3>& rgb,
                        float scale, std::string_view what) {
    std::array<std::vector<float>, 3> scaled = rgb;
    for (auto& plane : scaled)
        for (float& value : plane) value /= scale;
    const std::array<const float*, 3> planes = {scaled[0].data(), scaled[1].data(), scaled[2].data()};
    constexpr PixelFormat format = PixelFormat::bc6h_unsigned;
    std::vector<std::byte> data(byte_size(format, page.width, page.height));
    encode_texels(format, page.width, page.height, planes, data);
    return write_texture(*find_texture_container("ktx2").value(), file,
                         {format,
                          page.width,
                          page.height,
                          {data},
                          {{"lobelia.channels", std::string(what)}, {"lobelia.scale", fmt::format("{}", scale)}}});
}

}  // namespace

std::span<const LightmapExport> lightmap_exports() { return k_exports; }

Result<std::vector<const LightmapExport*>> find_lightmap_exports(const std::optional<std::vector<std::string>>& names) {
    std::vector<const LightmapExport*> found;
    if (!names) return found;
    for (const std::string& name : *names) {
        const auto entry =
            std::find_if(k_exports.begin(), k_exports.end(), [&](const LightmapExport& e) { return e.name == name; });
        if (entry == k_exports.end()) {
            std::string known;
            for (const LightmapExport& e : k_exports) known += (known.empty() ? "" : ", ") + std::string(e.name);
            return Error{fmt::format("unknown export \"{}\"; available: {}", name, known)};
        }
        if (std::find(found.begin(), found.end(), &*entry) == found.end()) found.push_back(&*entry);
    }
    return found;
}

Result<std::vector<GltfLightmap>> lightmaps_in_scene(const Bake& bake,
                                                     const std::vector<const LightmapExport*>& exports) {
    const auto entry = std::find_if(exports.begin(), exports.end(),
                                    [](const LightmapExport* e) { return e->place == LightmapExport::Place::scene; });
    std::vector<GltfLightmap> lightmaps;
    for (std::size_t i = 0; entry != exports.end() && i < bake.pages.size(); ++i) {
        const LightmapPage& page = bake.pages[i];
        const auto rgb = irradiance_of(page, bake.channels(), (*entry)->factor);
        const float largest = largest_of(rgb);
        GltfLightmap& lightmap = lightmaps.emplace_back();
        lightmap.intensity = largest > 0 ? largest : 1;
        Image image(page.width, page.height);
        for (std::size_t t = 0; t < page.size(); ++t) image.pixels[t] = {rgb[0][t], rgb[1][t], rgb[2][t]};
        auto png = encode_png(to_srgb(image, 1 / lightmap.intensity));
        if (!png) return Error{fmt::format("lightmap of page {}: {}", i, png.error().message)};
        lightmap.png = *std::move(png);
    }
    return lightmaps;
}

Status add_exports(FilesTogether& files, const Bake& bake, const std::vector<const LightmapExport*>& exports,
                   Manifest& manifest) {
    for (const LightmapExport* entry : exports)
        for (std::size_t i = 0; entry->place == LightmapExport::Place::files && i < bake.pages.size(); ++i) {
            const LightmapPage& page = bake.pages[i];
            const auto rgb = irradiance_of(page, bake.channels(), entry->factor);
            const std::string stem = fmt::format("page-{}.{}", i, entry->name);

            // Write red, green and blue, which is all that some readers accept.
            auto status = files.add(stem + ".exr", [&](StagedFile& file) {
                const std::vector<ExrChannel> channels{{"R", rgb[0]}, {"G", rgb[1]}, {"B", rgb[2]}};
                return write_exr(file, page.width, page.height, channels, {manifest.precision});
            });
            if (!status) return status;

            // Write the texture.
            const float largest = largest_of(rgb);
            const float scale = storing_scale(PixelFormat::bc6h_unsigned, largest);
            if (scale != 1)
                manifest.warnings.push_back(
                    fmt::format("{}.ktx2: values up to {:g} are divided by {:g}, for half floats cannot hold them",
                                stem, largest, scale));
            status = files.add(stem + ".ktx2", [&](StagedFile& file) {
                return write_texture_of(file, page, rgb, scale, entry->description);
            });
            if (!status) return status;
        }
    return Done{};
}

}  // namespace lobelia
