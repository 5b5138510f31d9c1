// Bilinear sampling of packed textures, one place at a time.
#include <algorithm>
#include <cmath>

#include "core/math/scratch.h"
#include "core/storage/components.h"
#include "lobelia/evaluate.h"

namespace lobelia {
namespace {

constexpr std::size_t k_most_channels = 4, k_most_block_texels = 16;

/// One axis of a bilinear lookup: two texels and the weight of the second.
struct Taps {
    std::size_t first, second;
    float weight;
    Taps(float coordinate, std::size_t size) {
        const float last = static_cast<float>(size - 1);
        // A NaN becomes 0.
        const float at = std::min(std::max(0.0f, coordinate * static_cast<float>(size) - 0.5f), last);
        first = static_cast<std::size_t>(at);
        second = std::min(first + 1, size - 1);
        weight = at - static_cast<float>(first);
    }
};

/// Decodes the block that holds a texel, unless it was the last one decoded.
class BlockReader {
  public:
    BlockReader(PixelFormat format, std::size_t width, std::span<const std::byte> data)
        : format_(format), info_(info(format)), blocks_across_((width + info_.block - 1) / info_.block), data_(data) {
        for (std::size_t k = 0; k < k_most_channels; ++k) channels_[k] = values_[k].data();
    }
    [[nodiscard]] std::array<float, k_most_channels> texel(std::size_t x, std::size_t y) {
        const std::size_t side = info_.block, block = y / side * blocks_across_ + x / side;
        if (block != block_) {
            decode_texels(format_, side, side, data_.subspan(block * info_.block_bytes, info_.block_bytes),
                          std::span(channels_).first(info_.channels));
            block_ = block;
        }
        std::array<float, k_most_channels> result{};
        for (std::size_t k = 0; k < info_.channels; ++k) result[k] = values_[k][y % side * side + x % side];
        return result;
    }

  private:
    PixelFormat format_;
    const FormatInfo& info_;
    std::size_t blocks_across_, block_ = static_cast<std::size_t>(-1);
    std::span<const std::byte> data_;
    std::array<std::array<float, k_most_block_texels>, k_most_channels> values_{};
    std::array<float*, k_most_channels> channels_{};
};

}  // namespace

Result<TextureSampler> TextureSampler::make(TextureLayout layout, std::span<const PackedTexture> textures) {
    if (textures.size() != layout.textures.size())
        return Error{std::to_string(textures.size()) + " textures, but the layout has " +
                     std::to_string(layout.textures.size())};
    std::vector<Texture> views;
    for (std::size_t i = 0; i < textures.size(); ++i) {
        const PackedTexture& t = textures[i];
        const bool fits = t.format == layout.textures[i].format && t.width > 0 && t.height > 0 &&
                          t.data.size() == byte_size(t.format, t.width, t.height);
        if (!fits)
            return Error{"texture \"" + t.name + "\" does not fit the layout's \"" + layout.textures[i].name +
                         "\": another format, or bytes that do not match its size"};
        views.push_back({t.format, t.width, t.height, t.scale, t.data});
    }
    return TextureSampler(std::move(layout), std::move(views));
}

std::array<float, 4> TextureSampler::filtered(const Texture& texture, Vec2 uv) {
    const Taps x(uv.x, texture.width), y(uv.y, texture.height);
    BlockReader reader(texture.format, texture.width, texture.data);
    const auto row = [&](std::size_t at) {
        const auto left = reader.texel(x.first, at), right = reader.texel(x.second, at);
        std::array<float, 4> result;
        for (std::size_t k = 0; k < 4; ++k) result[k] = left[k] + x.weight * (right[k] - left[k]);
        return result;
    };
    const auto above = row(y.first), below = row(y.second);
    std::array<float, 4> result;
    for (std::size_t k = 0; k < 4; ++k) result[k] = texture.scale * (above[k] + y.weight * (below[k] - above[k]));
    return result;
}

void TextureSampler::sample(Vec2 uv, std::span<Rgb> c) const {
    check_equal("coefficients", c.size(), layout_.coefficients);
    for (std::size_t i = 0; i < textures_.size(); ++i) {
        const auto stored = filtered(textures_[i], uv);
        const auto& channels = layout_.textures[i].channels;
        for (std::size_t k = 0; k < channels.size(); ++k) {
            const StoredChannel& channel = channels[k];
            const float value = (stored[k] - channel.offset) * (1 / channel.scale);
            const float* const shares = shares_of(channel.component).out;
            const Rgb part = {value * shares[0], value * shares[1], value * shares[2]};
            Rgb& colour = c[channel.coefficient];
            // Red, green and blue come one by one, luma before chroma: the first of them replaces what was there.
            const bool first = channel.component == Component::r || channel.component == Component::luma;
            if (first) colour = {};
            colour = colour + (channel.form == StoredChannel::Form::ratio
                                   ? Rgb{part.r * c[0].r, part.g * c[0].g, part.b * c[0].b}
                                   : part);
        }
    }
}

Rgb irradiance(const Evaluator& evaluator, const TextureSampler& textures, Vec2 uv, Vec3 normal) {
    const Scratch memory(3 * textures.coefficients());
    const std::span<Rgb> c(new (memory.data()) Rgb[textures.coefficients()], textures.coefficients());
    textures.sample(uv, c);
    return irradiance(evaluator, c, normal);
}

}  // namespace lobelia
