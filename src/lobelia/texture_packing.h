// How the coefficients of a texel lie in textures: which numbers, in which layers, in which format.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lobelia/math.h"

namespace lobelia {

/// How a texture stores red, green, blue and alpha. half: floats of 16 bits. unorm8: [0, 1] in 256 steps.
enum class TexelFormat { half, unorm8 };

/// One array of RGB layers in one format, and what each layer holds, as a formula.
struct TextureArray {
    std::string name;
    TexelFormat format = TexelFormat::half;
    std::vector<std::string> layers;
};

class TexturePacking {
  public:
    virtual ~TexturePacking() = default;
    /// In file names and on the command line.
    [[nodiscard]] virtual std::string name() const = 0;
    /// Number of coefficients that it packs.
    [[nodiscard]] virtual std::size_t coefficients() const = 0;
    /// How a shader reads it.
    [[nodiscard]] virtual std::string reading() const = 0;
    [[nodiscard]] virtual std::vector<TextureArray> textures() const = 0;
    /// From a texel's coefficients to one colour for each layer of all its textures, in order; within [0, 1] where the
    /// format is. Colours that no light has may be cut.
    virtual void pack(std::span<const Rgb> c, std::span<Rgb> layers) const = 0;
    virtual void unpack(std::span<const Rgb> layers, std::span<Rgb> c) const = 0;
};

/// Coefficient i in layer i of an array of halves; it suits every basis.
[[nodiscard]] std::shared_ptr<const TexturePacking> plain_packing(std::size_t coefficients);

}  // namespace lobelia
