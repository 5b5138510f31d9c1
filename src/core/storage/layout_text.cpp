// Writes layouts as text.
#include "core/storage/layout_text.h"

#include <array>
#include <charconv>

namespace lobelia {
namespace {

/// Writes as few digits as read back to the same float.
std::string number(float value) {
    char text[32];
    const auto [end, error] = std::to_chars(text, text + sizeof text, value);
    return error == std::errc() ? std::string(text, end) : "0";
}

std::string in_quotes(std::string_view text) { return "\"" + std::string(text) + "\""; }

std::string channel_json(const StoredChannel& channel) {
    const bool is_ratio = channel.form == StoredChannel::Form::ratio;
    return "{\"coefficient\": " + std::to_string(channel.coefficient) +
           ", \"component\": " + in_quotes(component_name(channel.component)) +
           ", \"form\": " + in_quotes(is_ratio ? "ratio" : "value") + ", \"scale\": " + number(channel.scale) +
           ", \"offset\": " + number(channel.offset) + "}";
}

}  // namespace

std::string_view component_name(Component component) {
    constexpr std::array<std::string_view, 6> names = {"r", "g", "b", "luma", "chroma_orange", "chroma_green"};
    return names[static_cast<std::size_t>(component)];
}

std::string texture_json(const TextureLayout::Texture& texture) {
    const FormatInfo& format = info(texture.format);
    std::string text = "{\"name\": " + in_quotes(texture.name) + ", \"format\": " + in_quotes(format.name) +
                       ", \"vk_format\": " + std::to_string(format.vk_format) +
                       ", \"subsampling\": " + std::to_string(texture.subsampling) + ", \"channels\": [";
    std::string_view separator;
    for (const StoredChannel& channel : texture.channels) {
        (text += separator) += channel_json(channel);
        separator = ", ";
    }
    return text + "]}";
}

std::string layout_json(const TextureLayout& layout) {
    std::string text = "{\"coefficients\": " + std::to_string(layout.coefficients) + ", \"textures\": [";
    std::string_view separator;
    for (const TextureLayout::Texture& texture : layout.textures) {
        (text += separator) += texture_json(texture);
        separator = ", ";
    }
    return text + "]}";
}

std::string channel_text(const StoredChannel& channel) {
    const auto part = [&](std::size_t coefficient) {
        return "c" + std::to_string(coefficient) + "." + std::string(component_name(channel.component));
    };
    std::string text = channel.offset != 0 ? number(channel.offset) + " + " : "";
    if (channel.scale != 1) text += number(channel.scale) + " ";
    text += part(channel.coefficient);
    return channel.form == StoredChannel::Form::ratio ? text + " / " + part(0) : text;
}

std::string channels_text(const TextureLayout::Texture& texture) {
    std::string text;
    for (const StoredChannel& channel : texture.channels) text += (text.empty() ? "" : "\n") + channel_text(channel);
    return text;
}

}  // namespace lobelia
