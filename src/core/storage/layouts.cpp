// Layouts that storages have in common.
#include "core/storage/layouts.h"

#include <algorithm>

namespace lobelia::layouts {
namespace {

using Form = StoredChannel::Form;

constexpr Widths k_unorm8{PixelFormat::r8, PixelFormat::rg8, PixelFormat::rgba8};

/// Appends textures that hold the channels four by four, and the last of them in as narrow a format as may be.
void append_tight(TextureLayout& layout, const std::string& name, const std::vector<StoredChannel>& channels,
                  const Widths& widths, std::size_t subsampling = 1) {
    for (std::size_t i = 0; i < channels.size(); i += 4) {
        const std::size_t count = std::min<std::size_t>(4, channels.size() - i);
        const PixelFormat format = count == 1 ? widths.one : count == 2 ? widths.two : widths.four;
        const auto begin = channels.begin() + static_cast<std::ptrdiff_t>(i);
        layout.textures.push_back({name + std::to_string(i / 4), format,
                                   std::vector(begin, begin + static_cast<std::ptrdiff_t>(count)), subsampling});
    }
}

std::vector<StoredChannel> rgb_of(std::size_t coefficient) {
    return {{coefficient, Component::r}, {coefficient, Component::g}, {coefficient, Component::b}};
}

/// The ratios of a coefficient to the leading one, which are within its bound, as numbers in [0, 1].
std::vector<StoredChannel> ratios_of(std::size_t coefficient, const CoefficientTraits& traits) {
    auto channels = rgb_of(coefficient);
    for (StoredChannel& channel : channels) {
        channel.form = Form::ratio;
        channel.scale = 0.5f / traits.lead_bounds[coefficient];
        channel.offset = 0.5f;
    }
    return channels;
}

}  // namespace

/// Every coefficient's channels as they are, one after the other.
TextureLayout tight(const CoefficientTraits& traits, const Widths& widths) {
    TextureLayout layout{traits.count, {}};
    std::vector<StoredChannel> channels;
    for (std::size_t i = 0; i < traits.count; ++i)
        for (const StoredChannel& channel : rgb_of(i)) channels.push_back(channel);
    append_tight(layout, "v", channels, widths);
    return layout;
}

/// A colour texture for each coefficient.
TextureLayout one_each(const CoefficientTraits& traits, PixelFormat format) {
    TextureLayout layout{traits.count, {}};
    for (std::size_t i = 0; i < traits.count; ++i)
        layout.textures.push_back({"c" + std::to_string(i), format, rgb_of(i)});
    return layout;
}

/// Luma in full, chroma for two by two texels, as halves.
TextureLayout luma_and_chroma(const CoefficientTraits& traits) {
    TextureLayout layout{traits.count, {}};
    std::vector<StoredChannel> luma, chroma;
    for (std::size_t i = 0; i < traits.count; ++i) {
        luma.push_back({i, Component::luma});
        chroma.push_back({i, Component::chroma_orange});
        chroma.push_back({i, Component::chroma_green});
    }
    append_tight(layout, "luma", luma, k_float16);
    append_tight(layout, "chroma", chroma, k_float16, 2);
    return layout;
}

/// The leading coefficient as a colour, the others as bytes that are ratios to it.
TextureLayout ratios_of_8_bits(const CoefficientTraits& traits, PixelFormat lead) {
    TextureLayout layout{traits.count, {{"c0", lead, rgb_of(0)}}};
    std::vector<StoredChannel> channels;
    for (std::size_t i = 1; i < traits.count; ++i)
        for (const StoredChannel& channel : ratios_of(i, traits)) channels.push_back(channel);
    append_tight(layout, "ratio", channels, k_unorm8);
    return layout;
}
TextureLayout ratios_of_10_bits(const CoefficientTraits& traits, PixelFormat lead) {
    TextureLayout layout{traits.count, {{"c0", lead, rgb_of(0)}}};
    for (std::size_t i = 1; i < traits.count; ++i)
        layout.textures.push_back({"ratio" + std::to_string(i), PixelFormat::rgb10a2, ratios_of(i, traits)});
    return layout;
}

}  // namespace lobelia::layouts
