// Which coefficient is in which channel of which texture: data that packing, unpacking, shaders and files all read.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "lobelia/pixel_format.h"
#include "lobelia/result.h"

namespace lobelia {

/// A part of a coefficient: a channel, or luma and chroma of Y = (r + 2g + b) / 4, Co = (r - b) / 2,
/// Cg = (2g - r - b) / 4, of which r = Y + Co - Cg, g = Y + Cg, b = Y - Co - Cg.
enum class Component : std::uint8_t { r, g, b, luma, chroma_orange, chroma_green };

/// What a channel holds: stored = scale v + offset. v is the coefficient's component, or its ratio to the same
/// component of coefficient 0, the leading one, as the textures before give that back (0 where that is 0).
struct StoredChannel {
    enum class Form : std::uint8_t { value, ratio };
    std::size_t coefficient = 0;
    Component component = Component::r;
    Form form = Form::value;
    float scale = 1, offset = 0;

    friend bool operator==(const StoredChannel&, const StoredChannel&) = default;
};

struct TextureLayout {
    struct Texture {
        std::string name;  ///< such as "c0", "ratio1": part of a file's name
        PixelFormat format = PixelFormat::rgba16f;
        std::vector<StoredChannel> channels;  ///< fewer than the format has: the others are 0
        std::size_t subsampling = 1;          ///< texels along one side of which a texel is the mean: 1 or 2
    };
    std::size_t coefficients = 0;
    std::vector<Texture> textures;  ///< the leading coefficient before what is a ratio to it
};

/// Whether what is read at a texel depends on its neighbours, too: blocks and sub-sampled textures.
[[nodiscard]] bool shares_texels(const TextureLayout& layout);

/// Bytes for one texel, blocks and sub-sampled textures shared out.
[[nodiscard]] double bytes_per_texel(const TextureLayout& layout);

/// Coefficients of width x height texels: plane 3 i + k is channel k of coefficient i, row by row.
template <class Float>
struct BasicCoefficientPlanes {
    std::size_t width = 0, height = 0;
    std::vector<Float*> planes;

    BasicCoefficientPlanes() = default;
    BasicCoefficientPlanes(std::size_t w, std::size_t h, std::vector<Float*> pointers)
        : width(w), height(h), planes(std::move(pointers)) {}
    /// Of any planes that have data(), such as those of a page, from the first on.
    template <class Plane>
    BasicCoefficientPlanes(std::size_t w, std::size_t h, std::span<Plane> of, std::size_t coefficients)
        : width(w), height(h) {
        check_range("planes", of.size(), 3 * coefficients, of.size());
        for (std::size_t i = 0; i < 3 * coefficients; ++i) planes.push_back(of[i].data());
    }
    /// What may be written may be read.
    BasicCoefficientPlanes(const BasicCoefficientPlanes<std::remove_const_t<Float>>& other)  // NOLINT
        requires std::is_const_v<Float>
        : width(other.width), height(other.height), planes(other.planes.begin(), other.planes.end()) {}
    [[nodiscard]] std::size_t size() const { return width * height; }
};
using CoefficientPlanes = BasicCoefficientPlanes<const float>;
using MutableCoefficientPlanes = BasicCoefficientPlanes<float>;

/// A texture as graphics interfaces and files take it.
struct PackedTexture {
    std::string name;
    PixelFormat format = PixelFormat::rgba16f;
    std::size_t width = 0, height = 0;  ///< texels
    float scale = 1;                    ///< what was stored is to be multiplied by this, before offset and scale
    std::vector<std::byte> data;
};

/// Packs coefficients by a layout, one texture for each of its textures; at least one texel.
[[nodiscard]] std::vector<PackedTexture> pack(const TextureLayout& layout, const CoefficientPlanes& coefficients);

/// The same, one texture after the other, for large pages: only the one that is handed over is in memory, and the
/// leading coefficient's where ratios to it follow. It ends with the first error that `take` returns.
using TakeTexture = std::function<Status(const TextureLayout::Texture& texture, const PackedTexture& packed)>;
[[nodiscard]] Status pack_each(const TextureLayout& layout, const CoefficientPlanes& coefficients,
                               const TakeTexture& take);

/// The inverse, for textures of this layout; sub-sampled ones are read as the nearest texel.
void unpack(const TextureLayout& layout, std::span<const PackedTexture> textures, const MutableCoefficientPlanes& out);

}  // namespace lobelia
