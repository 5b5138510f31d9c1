// The colonnade's materials.
#include <cmath>

#include "core/math/colour.h"
#include "scene/colonnade_parts.h"

namespace lobelia::colonnade {
namespace {

/// Makes a texture of two kinds of stone tiles with slightly different shades and dark joints; linear colours.
Texture tile_texture() {
    constexpr std::size_t k_tiles = 4, k_texels = 32, k_side = k_tiles * k_texels;
    constexpr std::array<Rgb, 2> k_stones{Rgb{0.62f, 0.53f, 0.42f}, Rgb{0.33f, 0.15f, 0.09f}};
    Texture texture;
    texture.name = "tiles";
    texture.width = texture.height = k_side;
    texture.texels.reserve(k_side * k_side);
    for (std::size_t y = 0; y < k_side; ++y)
        for (std::size_t x = 0; x < k_side; ++x) {
            const std::size_t tx = x / k_texels, ty = y / k_texels;
            const bool joint = x % k_texels == 0 || y % k_texels == 0;
            const float shade = 0.86f + 0.04f * static_cast<float>((7 * tx + 5 * ty + 3 * tx * ty) % 8);
            const Rgb color = joint ? Rgb{0.16f, 0.12f, 0.09f} : k_stones[(tx + ty) % 2] * shade;
            const auto byte = [](float linear) {
                return static_cast<std::uint8_t>(std::lround(255 * srgb_from_linear(static_cast<double>(linear))));
            };
            texture.texels.push_back({byte(color.r), byte(color.g), byte(color.b), 255});
        }
    return texture;
}

}  // namespace

Materials add_materials(SceneBuilder& builder) {
    const auto plain = [&](const char* name, Rgb color, float roughness = 0.9f) {
        Material material;
        material.name = name;
        material.base_color = color;
        material.roughness = roughness;
        return material;
    };
    const auto cloth = [&](const char* name, Rgb color) {
        Material material = plain(name, color, 1);
        material.double_sided = true;
        material.specular = 0;
        return material;
    };
    builder.scene().textures.push_back(tile_texture());
    Material tiles = plain("tiles", {1, 1, 1}, 0.45f);
    tiles.base_color_texture = TextureUse{};
    Material bronze = plain("bronze", {0.55f, 0.34f, 0.14f}, 0.35f);
    bronze.metallic = 1;
    return {builder.material(plain("stone", {0.66f, 0.58f, 0.46f})),
            builder.material(plain("plaster", {0.74f, 0.66f, 0.54f})),
            builder.material(plain("dado", {0.42f, 0.12f, 0.07f})),
            builder.material(plain("ceiling", {0.70f, 0.64f, 0.55f})),
            builder.material(plain("timber", {0.20f, 0.11f, 0.06f})),
            builder.material(tiles),
            builder.material(plain("gravel", {0.30f, 0.25f, 0.18f}, 1)),
            builder.material(plain("roof", {0.45f, 0.20f, 0.12f})),
            builder.material(cloth("red cloth", {0.58f, 0.045f, 0.03f})),
            builder.material(cloth("blue cloth", {0.04f, 0.12f, 0.46f})),
            builder.material(cloth("ochre cloth", {0.72f, 0.36f, 0.05f})),
            builder.material(bronze),
            builder.material(plain("terracotta", {0.52f, 0.20f, 0.10f})),
            builder.material(plain("leaves", {0.07f, 0.14f, 0.035f}))};
}

}  // namespace lobelia::colonnade
