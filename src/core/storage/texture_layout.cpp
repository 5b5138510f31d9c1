// Packs and unpacks coefficients as a layout says.
#include "lobelia/texture_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>

#include "core/stop.h"
#include "core/storage/components.h"

namespace lobelia {
namespace {

using Form = StoredChannel::Form;
using Texture = TextureLayout::Texture;

/// Texels that are prepared and encoded at a time, so that they stay in the cache between the two.
constexpr std::size_t k_strip = 4096;

bool is_rgb(Component component) { return component <= Component::b; }
std::size_t rgb_index(Component component) { return static_cast<std::size_t>(component); }

std::size_t divided(std::size_t size, std::size_t subsampling) { return (size + subsampling - 1) / subsampling; }

/// Returns whether a channel stores a plane unchanged.
bool is_plane(const StoredChannel& channel, const Texture& texture, float scale) {
    return is_rgb(channel.component) && channel.form == Form::value && channel.scale == 1 && channel.offset == 0 &&
           texture.subsampling == 1 && scale == 1;
}

/// Rows of the leading coefficient as they will be read back, its three channels.
using LeadRows = std::array<std::vector<float>, 3>;

/// Fills rows of a texture with what a channel stores.
class ChannelSource {
  public:
    ChannelSource(const CoefficientPlanes& planes, const Texture& texture, float scale)
        : planes_(planes), texture_(texture), inverse_scale_(1 / scale) {}

    /// Ratios are to `lead`, which begins with the planes' row that row y is made of.
    void set_lead(LeadRows lead, std::size_t y) {
        lead_ = std::move(lead);
        lead_begin_ = y * texture_.subsampling * planes_.width;
    }
    void fill(const StoredChannel& channel, std::size_t y, std::size_t rows, float* out) const {
        const std::size_t width = divided(planes_.width, texture_.subsampling);
        for (std::size_t row = 0; row < rows; ++row) {
            float* to = out + row * width;
            if (texture_.subsampling == 1)
                fill_row(channel, (y + row) * planes_.width, planes_.width, to);
            else
                fill_mean(channel, y + row, to);
            for (std::size_t x = 0; x < width; ++x) to[x] = to[x] * channel.scale + channel.offset;
        }
    }

  private:
    /// Values of a component, or ratios, from texel `begin` on.
    void fill_row(const StoredChannel& channel, std::size_t begin, std::size_t count, float* out) const {
        const float* const* rgb = planes_.planes.data() + 3 * channel.coefficient;
        if (!is_rgb(channel.component)) {
            const float* s = shares_of(channel.component).in;
            const float *r = rgb[0] + begin, *g = rgb[1] + begin, *b = rgb[2] + begin;
            for (std::size_t i = 0; i < count; ++i) out[i] = (s[0] * r[i] + s[1] * g[i] + s[2] * b[i]) * inverse_scale_;
            return;
        }
        const float* value = rgb[rgb_index(channel.component)] + begin;
        if (channel.form == Form::value) {
            for (std::size_t i = 0; i < count; ++i) out[i] = value[i] * inverse_scale_;
            return;
        }
        const float* lead = lead_[rgb_index(channel.component)].data() + (begin - lead_begin_);
        for (std::size_t i = 0; i < count; ++i) {
            const float divisor = lead[i] != 0 ? lead[i] : HUGE_VALF;
            out[i] = value[i] / divisor;
        }
    }

    /// Means of squares of two by two texels; at odd ends of what there is.
    void fill_mean(const StoredChannel& channel, std::size_t y, float* out) const {
        const std::size_t width = planes_.width;
        std::vector<float> rows[2];
        for (std::size_t k = 0; k < 2; ++k) {
            rows[k].resize(width);
            fill_row(channel, std::min(2 * y + k, planes_.height - 1) * width, width, rows[k].data());
        }
        for (std::size_t x = 0; x < width; x += 2) {
            const std::size_t right = std::min(x + 1, width - 1);
            out[x / 2] = 0.25f * (rows[0][x] + rows[0][right] + rows[1][x] + rows[1][right]);
        }
    }

    const CoefficientPlanes& planes_;
    const Texture& texture_;
    LeadRows lead_;
    std::size_t lead_begin_ = 0;
    float inverse_scale_;
};

/// The largest magnitude of what a texture is to hold, before its scale; an upper bound for luma and chroma.
float largest_of(const Texture& texture, const CoefficientPlanes& planes) {
    float largest = 0;
    for (const StoredChannel& channel : texture.channels) {
        if (channel.form == Form::ratio) continue;
        for (std::size_t k = 0; k < 3; ++k)
            if (shares_of(channel.component).in[k] != 0)
                largest =
                    std::max(largest, largest_magnitude(planes.planes[3 * channel.coefficient + k], planes.size()));
    }
    return largest;
}

/// Writes each of the first `count` entries twice, from the end.
void repeat_each(std::span<float> row, std::size_t count) {
    for (std::size_t x = count; x-- > 0;) row[2 * x] = row[2 * x + 1] = row[x];
}

/// Puts what a channel of a texture gives back where it belongs. Luma comes before chroma, and both add up.
void unpack_channel(const StoredChannel& channel, const Texture& texture, const PackedTexture& packed,
                    const float* decoded, const MutableCoefficientPlanes& out) {
    const ComponentShares& shares = shares_of(channel.component);
    const float inverse = 1 / channel.scale;
    std::vector<float> row(packed.width * texture.subsampling);
    for (std::size_t y = 0; y < out.height; ++y) {
        // Decode the channel along a row of texels.
        const float* from = decoded + y / texture.subsampling * packed.width;
        for (std::size_t x = 0; x < packed.width; ++x) row[x] = (from[x] * packed.scale - channel.offset) * inverse;
        if (texture.subsampling == 2) repeat_each(row, packed.width);

        for (std::size_t k = 0; k < 3; ++k) {
            const float share = shares.out[k];
            if (share == 0) continue;
            const float* lead = out.planes[k] + y * out.width;
            float* plane = out.planes[3 * channel.coefficient + k] + y * out.width;
            if (channel.form == Form::ratio)
                for (std::size_t x = 0; x < out.width; ++x) plane[x] = row[x] * share * lead[x];
            else if (channel.component > Component::luma)
                for (std::size_t x = 0; x < out.width; ++x) plane[x] += row[x] * share;
            else
                for (std::size_t x = 0; x < out.width; ++x) plane[x] = row[x] * share;
        }
    }
}

void unpack_texture(const Texture& texture, const PackedTexture& packed, const MutableCoefficientPlanes& out) {
    const FormatInfo& format = info(texture.format);
    check_equal("format of the texture", static_cast<std::size_t>(packed.format),
                static_cast<std::size_t>(texture.format));
    check_equal("width of the texture", packed.width, divided(out.width, texture.subsampling));
    check_equal("height of the texture", packed.height, divided(out.height, texture.subsampling));
    std::vector<std::vector<float>> decoded(format.channels);
    std::vector<float*> channels(format.channels);
    const auto goes_straight = [&](std::size_t k) {
        return k < texture.channels.size() && is_plane(texture.channels[k], texture, packed.scale);
    };
    for (std::size_t k = 0; k < format.channels; ++k) {
        if (goes_straight(k)) {
            channels[k] = out.planes[3 * texture.channels[k].coefficient + rgb_index(texture.channels[k].component)];
        } else {
            decoded[k].resize(packed.width * packed.height);
            channels[k] = decoded[k].data();
        }
    }
    decode_texels(texture.format, packed.width, packed.height, packed.data, channels);
    for (std::size_t k = 0; k < texture.channels.size(); ++k)
        if (!goes_straight(k)) unpack_channel(texture.channels[k], texture, packed, decoded[k].data(), out);
}

/// Planes for all coefficients of the layout, of at least one texel.
void check_planes(const TextureLayout& layout, const CoefficientPlanes& planes,
                  SourcePlace place = SourcePlace::here()) {
    check_equal("planes of coefficients", planes.planes.size(), 3 * layout.coefficients, place);
    check_range("texels", planes.size(), 1, SIZE_MAX, place);
}

float scale_of(const Texture& texture, const CoefficientPlanes& planes) {
    return storing_scale(texture.format, largest_of(texture, planes));
}

bool has_ratios(const Texture& texture) {
    return std::any_of(texture.channels.begin(), texture.channels.end(),
                       [](const StoredChannel& channel) { return channel.form == Form::ratio; });
}

bool holds_lead(const Texture& texture) {
    return std::any_of(texture.channels.begin(), texture.channels.end(),
                       [](const StoredChannel& channel) { return channel.coefficient == 0; });
}

/// Rows [y, y + rows) of a page, of a texture of it; y is a multiple of k_row_step.
constexpr std::size_t k_row_step = 8;  ///< a block of 4 rows, sub-sampled by 2
PackedTexture rows_of(const Texture& texture, const PackedTexture& packed, std::size_t y, std::size_t rows) {
    const std::size_t begin = y / texture.subsampling, count = divided(rows, texture.subsampling);
    const auto bytes =
        std::span(packed.data)
            .subspan(byte_size(texture.format, packed.width, begin), byte_size(texture.format, packed.width, count));
    return {packed.name, packed.format, packed.width, count, packed.scale, std::vector(bytes.begin(), bytes.end())};
}

/// The textures that hold the leading coefficient, once they are packed.
class PackedLead {
  public:
    void add(const Texture& texture, const PackedTexture& packed) {
        textures_.push_back(&texture);
        packed_.push_back(&packed);
    }
    /// Rows of it as they are read back; other coefficients in the same textures are of no interest.
    [[nodiscard]] LeadRows read(const CoefficientPlanes& planes, std::size_t y, std::size_t rows) const {
        LeadRows lead;
        for (auto& channel : lead) channel.resize(rows * planes.width);
        std::vector<float> rest(rows * planes.width);
        MutableCoefficientPlanes out(planes.width, rows, std::vector<float*>(planes.planes.size(), rest.data()));
        for (std::size_t k = 0; k < 3; ++k) out.planes[k] = lead[k].data();
        for (std::size_t i = 0; i < packed_.size(); ++i)
            unpack_texture(*textures_[i], rows_of(*textures_[i], *packed_[i], y, rows), out);
        return lead;
    }

  private:
    std::vector<const Texture*> textures_;
    std::vector<const PackedTexture*> packed_;
};

PackedTexture pack_texture(const Texture& texture, const CoefficientPlanes& planes, const PackedLead& lead, float scale,
                           StopFlag stop) {
    const FormatInfo& format = info(texture.format);
    PackedTexture packed{texture.name,
                         texture.format,
                         divided(planes.width, texture.subsampling),
                         divided(planes.height, texture.subsampling),
                         scale,
                         {}};
    packed.data.resize(byte_size(texture.format, packed.width, packed.height));
    ChannelSource source(planes, texture, packed.scale);

    // Prepare a strip of rows, whole blocks of them, and encode it.
    const std::size_t step = has_ratios(texture) ? k_row_step : format.block;
    const std::size_t strip = std::max<std::size_t>(1, k_strip / packed.width / step) * step;
    std::vector<std::vector<float>> prepared(format.channels);
    std::vector<const float*> channels(format.channels);
    for (std::size_t y = 0; y < packed.height; y += strip) {
        stop.check();
        const std::size_t rows = std::min(strip, packed.height - y);
        if (has_ratios(texture)) {
            const std::size_t top = y * texture.subsampling;
            source.set_lead(lead.read(planes, top, std::min(rows * texture.subsampling, planes.height - top)), y);
        }
        for (std::size_t k = 0; k < format.channels; ++k) {
            const bool used = k < texture.channels.size();
            if (used && is_plane(texture.channels[k], texture, packed.scale)) {
                const StoredChannel& channel = texture.channels[k];
                channels[k] = planes.planes[3 * channel.coefficient + rgb_index(channel.component)] + y * packed.width;
                continue;
            }
            prepared[k].resize(rows * packed.width);
            if (used) source.fill(texture.channels[k], y, rows, prepared[k].data());
            channels[k] = prepared[k].data();
        }
        encode_texels(
            texture.format, packed.width, rows, channels,
            std::span(packed.data)
                .subspan(byte_size(texture.format, packed.width, y), byte_size(texture.format, packed.width, rows)));
    }
    return packed;
}

}  // namespace

bool shares_texels(const TextureLayout& layout) {
    return std::any_of(layout.textures.begin(), layout.textures.end(), [](const TextureLayout::Texture& texture) {
        return texture.subsampling > 1 || info(texture.format).block > 1;
    });
}

double bytes_per_texel(const TextureLayout& layout) {
    double bytes = 0;
    for (const Texture& texture : layout.textures) {
        const FormatInfo& format = info(texture.format);
        const std::size_t side = format.block * texture.subsampling;
        bytes += static_cast<double>(format.block_bytes) / static_cast<double>(side * side);
    }
    return bytes;
}

std::vector<PackedTexture> pack(const TextureLayout& layout, const CoefficientPlanes& coefficients) {
    check_planes(layout, coefficients);
    std::vector<PackedTexture> packed;
    packed.reserve(layout.textures.size());
    PackedLead lead;
    for (const Texture& texture : layout.textures) {
        packed.push_back(pack_texture(texture, coefficients, lead, scale_of(texture, coefficients), {}));
        if (holds_lead(texture)) lead.add(texture, packed.back());
    }
    return packed;
}

Status pack_each(const TextureLayout& layout, const CoefficientPlanes& coefficients, const TakeTexture& take,
                 const std::atomic<bool>* stop, std::span<const float> scales) {
    check_planes(layout, coefficients);
    if (!scales.empty()) check_equal("scales", scales.size(), layout.textures.size());
    const bool keeps_lead = std::any_of(layout.textures.begin(), layout.textures.end(), has_ratios);
    return unless_stopped([&]() -> Status {
        std::deque<PackedTexture> kept;
        PackedLead lead;
        for (std::size_t i = 0; i < layout.textures.size(); ++i) {
            const Texture& texture = layout.textures[i];
            const float scale = scales.empty() ? scale_of(texture, coefficients) : scales[i];
            PackedTexture packed = pack_texture(texture, coefficients, lead, scale, stop);
            if (Status status = take(texture, packed); !status) return status;
            if (keeps_lead && holds_lead(texture)) lead.add(texture, kept.emplace_back(std::move(packed)));
        }
        return Done{};
    });
}

void unpack(const TextureLayout& layout, std::span<const PackedTexture> textures, const MutableCoefficientPlanes& out) {
    check_planes(layout, out);
    check_equal("textures", textures.size(), layout.textures.size());
    for (std::size_t i = 0; i < textures.size(); ++i) unpack_texture(layout.textures[i], textures[i], out);
}

}  // namespace lobelia
