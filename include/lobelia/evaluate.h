// Evaluation with coefficients per place: planes of them (a page of texels), packed textures.
#pragma once

#include "lobelia/basis.h"
#include "lobelia/result.h"
#include "lobelia/texture_layout.h"

namespace lobelia {

/// Coefficients of many places: pointer 3 i + k is channel k of coefficient i, one float per place. Those of
/// CoefficientPlanes, or the caller's own arrays.
using CoefficientPointers = std::span<const float* const>;

/// Evaluates E [W/m^2] of place j at normal j, clamped if the evaluator clamps. Preconditions: c.size() = 3 x
/// coefficients, each of normals.size floats.
void irradiance(const Evaluator& evaluator, CoefficientPointers c, DirectionView normals, MutableColourView out);

/// Evaluates L [W/(m^2 sr)] of place j in direction j, without clamping. Preconditions as above.
void radiance(const Basis& basis, CoefficientPointers c, DirectionView directions, MutableColourView out);

/// Packed textures of any storage, sampled as a shader does: each texture bilinearly between its texel centres (clamped
/// at the edges), then the layout's arithmetic. (0, 0) is the corner of the first texel, (1, 1) that of the last.
/// Texels are decoded at each lookup; nothing is unpacked or allocated.
class TextureSampler {
  public:
    /// Makes a sampler; the textures' bytes must outlive it. Errors: textures that do not fit the layout.
    [[nodiscard]] static Result<TextureSampler> make(TextureLayout layout, std::span<const PackedTexture> textures);

    [[nodiscard]] std::size_t coefficients() const { return layout_.coefficients; }
    /// Samples the coefficients at uv. Precondition: c.size() = coefficients().
    void sample(Vec2 uv, std::span<Rgb> c) const;

  private:
    struct Texture {
        PixelFormat format;
        std::size_t width, height;
        float scale;
        std::span<const std::byte> data;
    };
    TextureSampler(TextureLayout layout, std::vector<Texture> textures)
        : layout_(std::move(layout)), textures_(std::move(textures)) {}
    [[nodiscard]] static std::array<float, 4> filtered(const Texture& texture, Vec2 uv);

    TextureLayout layout_;
    std::vector<Texture> textures_;
};

/// Evaluates E [W/m^2] at uv of a texture, for a normal in the frame of the coefficients.
[[nodiscard]] Rgb irradiance(const Evaluator& evaluator, const TextureSampler& textures, Vec2 uv, Vec3 normal);

}  // namespace lobelia
