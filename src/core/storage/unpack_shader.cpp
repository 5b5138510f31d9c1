// Writes the unpacking of a layout, coefficient by coefficient: as whole colours where its channels allow it.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/math/shader_text.h"
#include "core/math/ycocg_shader.h"
#include "core/storage/layout_text.h"
#include "lobelia/texture_layout.h"

namespace lobelia {
namespace {

using Form = StoredChannel::Form;
using Texture = TextureLayout::Texture;

constexpr const char* k_components = "xyzw";

/// A channel that holds a component of a coefficient, and its place.
struct StoredPlace {
    const Texture* texture = nullptr;
    std::size_t channel = 0;

    [[nodiscard]] const StoredChannel& stored() const { return texture->channels[channel]; }
};

std::vector<StoredPlace> places_of(const TextureLayout& layout, std::size_t coefficient) {
    std::vector<StoredPlace> places;
    for (const Texture& texture : layout.textures)
        for (std::size_t k = 0; k < texture.channels.size(); ++k)
            if (texture.channels[k].coefficient == coefficient) places.push_back({&texture, k});
    return places;
}

std::optional<StoredPlace> place_of(const std::vector<StoredPlace>& places, Component component) {
    const auto found = std::find_if(places.begin(), places.end(),
                                    [&](const StoredPlace& place) { return place.stored().component == component; });
    return found != places.end() ? std::optional(*found) : std::nullopt;
}

/// The code of the colour, or of one component of it, that a texture of a format with a decode_function() holds.
std::string decoded_code(const Texture& texture, const std::string& component = {}) {
    const std::string name = "t." + texture.name;
    return decode_function(texture.format)->name + "(" + name + ")" + component + " * " + name + "_scale";
}

/// The code of a stored value.
std::string stored_value(const StoredPlace& place) {
    const std::string component = {'.', k_components[place.channel]};
    if (decode_function(place.texture->format)) return decoded_code(*place.texture, component);
    return "t." + place.texture->name + component;
}

/// The code of the value v of a channel from that of the stored one: "3.4641016 * stored - 1.7320508".
std::string channel_code(const StoredChannel& channel, const std::string& stored) {
    using shader_text::literal;
    const double scale = channel.scale, offset = channel.offset;
    std::string text = scale == 1 ? stored : literal(1 / scale) + " * " + stored;
    if (offset != 0) text += (offset / scale > 0 ? " - " : " + ") + literal(std::abs(offset / scale));
    return text;
}

/// The code of a channel's value, or "0.0" where it is not stored.
std::string value_code(const std::optional<StoredPlace>& place) {
    if (!place) return "0.0";
    const std::string code = channel_code(place->stored(), stored_value(*place));
    if (place->stored().form == Form::value) return code;
    const std::string lead =
        std::string("light.c[0].") + k_components[static_cast<std::size_t>(place->stored().component)];
    const bool sum = place->stored().offset != 0;
    return lead + " * " + (sum ? "(" + code + ")" : code);
}

using Colour = std::array<std::optional<StoredPlace>, 3>;

bool all_like_the_first(const Colour& colour) {
    return std::all_of(colour.begin(), colour.end(), [&](const std::optional<StoredPlace>& place) {
        if (!place || !colour[0]) return false;
        const StoredChannel &a = colour[0]->stored(), &b = place->stored();
        return a.form == b.form && a.scale == b.scale && a.offset == b.offset;
    });
}

/// The code of three stored values as a vec3.
std::string stored_colour(const Colour& colour) {
    const Texture& texture = *colour[0]->texture;
    const auto in_order = [&](std::size_t k) { return colour[k]->texture == &texture && colour[k]->channel == k; };
    if (decode_function(texture.format) && in_order(0) && in_order(1) && in_order(2)) return decoded_code(texture);
    return "vec3(" + stored_value(*colour[0]) + ", " + stored_value(*colour[1]) + ", " + stored_value(*colour[2]) + ")";
}

/// The code of a coefficient of which red, green and blue are stored.
std::string colour_code(const Colour& colour) {
    if (!all_like_the_first(colour))
        return "vec3(" + value_code(colour[0]) + ", " + value_code(colour[1]) + ", " + value_code(colour[2]) + ")";
    const StoredChannel& channel = colour[0]->stored();
    const std::string code = channel_code(channel, stored_colour(colour));
    if (channel.form == Form::value) return code;
    return "light.c[0] * " + (channel.offset != 0 ? "(" + code + ")" : code);
}

/// Writes the struct of sampled values.
std::string texel_text(const TextureLayout& layout) {
    std::string text =
        "/// Sampled values at one place, times the scale of their texture in bake.json, except where NAME_scale is "
        "that "
        "scale.\nstruct Texel {\n";
    for (const Texture& texture : layout.textures) {
        const bool decoded_here = decode_function(texture.format) != nullptr;
        std::string channels;
        for (const StoredChannel& channel : texture.channels)
            channels += (channels.empty() ? "" : ", ") + channel_text(channel);
        text += "    // " + texture.name + " (" + std::string(info(texture.format).name) +
                (texture.subsampling == 2 ? " of half the width and height" : "") +
                (decoded_here ? " as RGBA8, not filtered" : "") + "): " + channels + "\n";
        text += "    vec4 " + texture.name + ";\n";
        if (decoded_here) text += "    float " + texture.name + "_scale;\n";
    }
    return text + "};\n";
}

}  // namespace

UnpackCode unpack_code(const TextureLayout& layout) {
    UnpackCode code{{}, texel_text(layout), "    Coefficients light;\n"};
    const auto add = [&](const ShaderFunction& function) {
        if (std::find(code.functions.begin(), code.functions.end(), function) == code.functions.end())
            code.functions.push_back(function);
    };

    for (const Texture& texture : layout.textures)
        if (const ShaderFunction* decode = decode_function(texture.format)) add(*decode);
    for (std::size_t i = 0; i < layout.coefficients; ++i) {
        const auto places = places_of(layout, i);
        std::string colour;
        if (const auto luma = place_of(places, Component::luma)) {
            add(shader_text::rgb_from_ycocg());
            colour = "rgb_from_ycocg(" + value_code(luma) + ", " +
                     value_code(place_of(places, Component::chroma_orange)) + ", " +
                     value_code(place_of(places, Component::chroma_green)) + ")";
        } else {
            colour = colour_code(
                {place_of(places, Component::r), place_of(places, Component::g), place_of(places, Component::b)});
        }
        code.body += "    " + shader_text::coefficient(i) + " = " + colour + ";\n";
    }
    code.body += "    return light;\n";
    return code;
}

}  // namespace lobelia
