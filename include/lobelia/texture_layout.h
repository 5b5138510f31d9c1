// Texture layouts: the channel of each coefficient, as data for packing, unpacking, shaders and files.
#pragma once

#include <atomic>
#include <functional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "lobelia/pixel_format.h"
#include "lobelia/result.h"
#include "lobelia/shader_code.h"

namespace lobelia {

/// A component of a coefficient: a channel, or luma and chroma. Y = (r + 2g + b) / 4, Co = (r - b) / 2, Cg = (2g - r -
/// b) / 4; inversely r = Y + Co - Cg, g = Y + Cg, b = Y - Co - Cg.
enum class Component : std::uint8_t { r, g, b, luma, chroma_orange, chroma_green };

/// The content of a channel: stored = scale v + offset. v is the coefficient's component, or its ratio to the same
/// component of coefficient 0, the leading one, as decoded from the preceding textures (0 if that is 0).
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
        std::string name;  ///< such as "c0", "ratio1"; part of a file's name
        PixelFormat format = PixelFormat::rgba16f;
        std::vector<StoredChannel> channels;  ///< may be fewer than the format has: the others are 0
        std::size_t subsampling = 1;          ///< 1, or 2: each texel is the mean of 2 x 2
    };
    std::size_t coefficients = 0;
    std::vector<Texture> textures;  ///< the leading coefficient before the ratios to it
};

/// Returns whether the value at a texel depends on its neighbours: true for blocks and sub-sampled textures.
[[nodiscard]] bool shares_texels(const TextureLayout& layout);

/// Returns bytes per texel; the bytes of blocks and sub-sampled textures are divided among their texels.
[[nodiscard]] double bytes_per_texel(const TextureLayout& layout);

/// Coefficients of width x height texels: plane 3 i + k is channel k of coefficient i, row by row.
template <class Float>
struct BasicCoefficientPlanes {
    std::size_t width = 0, height = 0;
    std::vector<Float*> planes;

    BasicCoefficientPlanes() = default;
    BasicCoefficientPlanes(std::size_t w, std::size_t h, std::vector<Float*> pointers)
        : width(w), height(h), planes(std::move(pointers)) {}
    /// Makes planes from objects that have data(), such as those of a page, from the first on.
    template <class Plane>
    BasicCoefficientPlanes(std::size_t w, std::size_t h, std::span<Plane> of, std::size_t coefficients)
        : width(w), height(h) {
        check_range("planes", of.size(), 3 * coefficients, of.size());
        for (std::size_t i = 0; i < 3 * coefficients; ++i) planes.push_back(of[i].data());
    }
    /// Converts writable planes to read-only ones.
    BasicCoefficientPlanes(const BasicCoefficientPlanes<std::remove_const_t<Float>>& other)  // NOLINT
        requires std::is_const_v<Float>
        : width(other.width), height(other.height), planes(other.planes.begin(), other.planes.end()) {}
    [[nodiscard]] std::size_t size() const { return width * height; }
};
using CoefficientPlanes = BasicCoefficientPlanes<const float>;
using MutableCoefficientPlanes = BasicCoefficientPlanes<float>;

/// A texture for graphics interfaces and files.
struct PackedTexture {
    std::string name;
    PixelFormat format = PixelFormat::rgba16f;
    std::size_t width = 0, height = 0;  ///< texels
    float scale = 1;                    ///< multiply stored values by this, before offset and scale
    std::vector<std::byte> data;
};

/// Packs coefficients by a layout into one texture for each of the layout's. Precondition: at least one texel.
[[nodiscard]] std::vector<PackedTexture> pack(const TextureLayout& layout, const CoefficientPlanes& coefficients);

/// Packs one texture after the other, for large pages: memory holds only the current one, and the leading coefficient's
/// if ratios to it follow. Ends with the first error that `take` returns, or with one when `stop` becomes true.
/// `scales` are those of the textures, for mip levels, which have those of the largest one; empty: as values require.
using TakeTexture = std::function<Status(const TextureLayout::Texture& texture, const PackedTexture& packed)>;
[[nodiscard]] Status pack_each(const TextureLayout& layout, const CoefficientPlanes& coefficients,
                               const TakeTexture& take, const std::atomic<bool>* stop = nullptr,
                               std::span<const float> scales = {});

/// Unpacks textures of this layout; sub-sampled ones are sampled at the nearest texel.
void unpack(const TextureLayout& layout, std::span<const PackedTexture> textures, const MutableCoefficientPlanes& out);

/// Shader code that unpacks the textures of a layout at one place.
struct UnpackCode {
    std::vector<ShaderFunction> functions;  ///< functions that `body` calls
    std::string texel;                      ///< struct Texel, sampled values, with a comment for each texture
    std::string body;                       ///< statements of Coefficients unpack(Texel t), the last one returns
};

/// Writes the code. Texel has a vec4 with the name of each texture: sampled values times the texture's scale (field
/// "scale" of bake.json). For formats with a decode_function() it is the sampled value alone, without filtering, and a
/// float NAME_scale follows it, which is to be that scale.
[[nodiscard]] UnpackCode unpack_code(const TextureLayout& layout);

}  // namespace lobelia
