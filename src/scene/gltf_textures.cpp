// Textures of a glTF file: pictures with the way they repeat.
#include "scene/gltf_textures.h"

#include "io/read_picture.h"

namespace lobelia::gltf {
namespace {

std::optional<Texture::Wrap> wrap_of(int mode) {
    switch (mode) {
        case TINYGLTF_TEXTURE_WRAP_REPEAT:
            return Texture::Wrap::repeat;
        case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
            return Texture::Wrap::mirror;
        case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
            return Texture::Wrap::clamp;
        default:
            return std::nullopt;
    }
}

/// The bytes of an image's file.
Result<Bytes> image_bytes(Document& document, std::size_t image, const std::string& place) {
    const ImageSource& source = document.images[image];
    if (source.buffer_view) {
        if (*source.buffer_view > static_cast<std::size_t>(std::numeric_limits<int>::max()))
            return document.error(place, "no such bufferView");
        return view_bytes(document, static_cast<int>(*source.buffer_view), place);
    }
    auto bytes = document.resources.get(source.uri);
    if (!bytes) return document.error(place + ".uri", bytes.error().message);
    return bytes;
}

/// What makes two of the file's textures one.
using Key = std::tuple<std::size_t, Texture::Wrap, Texture::Wrap>;

/// Sampler and image of a texture; nothing where it has only an image of a format that is not read.
Result<std::optional<Key>> key_of(Document& document, std::size_t t) {
    const tinygltf::Texture& texture = document.model.textures[t];
    const std::string place = fmt::format("textures[{}]", t);
    Texture::Wrap wrap_u = Texture::Wrap::repeat, wrap_v = Texture::Wrap::repeat;
    if (texture.sampler >= 0) {
        const auto& samplers = document.model.samplers;
        if (static_cast<std::size_t>(texture.sampler) >= samplers.size())
            return document.error(place + ".sampler", fmt::format("{} of {}", texture.sampler, samplers.size()));
        const auto& sampler = samplers[static_cast<std::size_t>(texture.sampler)];
        const auto u = wrap_of(sampler.wrapS), v = wrap_of(sampler.wrapT);
        if (!u || !v)
            return document.error(fmt::format("samplers[{}]", texture.sampler), "neither repeat, mirror nor clamp");
        wrap_u = *u;
        wrap_v = *v;
    }
    if (texture.source < 0) {
        if (texture.extensions.empty()) return document.error(place + ".source", "missing");
        document.warn(place, fmt::format("its only image is in {}; left out (gltf-transform converts textures)",
                                         texture.extensions.begin()->first));
        return std::optional<Key>();
    }
    if (static_cast<std::size_t>(texture.source) >= document.images.size())
        return document.error(place + ".source", fmt::format("{} of {}", texture.source, document.images.size()));
    return std::optional<Key>({static_cast<std::size_t>(texture.source), wrap_u, wrap_v});
}

Result<Texture> decode(Document& document, const Key& key, std::size_t most_texels) {
    const auto& [image, wrap_u, wrap_v] = key;
    const std::string place = fmt::format("images[{}]", image);
    const auto bytes = image_bytes(document, image, place);
    if (!bytes) return bytes.error();
    auto picture = read_picture_rgba8(*bytes, document.name + ": " + place, most_texels);
    if (!picture) return picture.error();
    Texture texture;
    texture.name = document.images[image].name;
    texture.width = picture->width;
    texture.height = picture->height;
    texture.texels = std::move(picture->texels);
    texture.wrap_u = wrap_u;
    texture.wrap_v = wrap_v;
    return texture;
}

}  // namespace

Result<std::vector<std::optional<std::size_t>>> read_textures(Document& document, const std::vector<bool>& used,
                                                              std::vector<Texture>& textures) {
    std::vector<std::optional<std::size_t>> of_texture(document.model.textures.size());
    std::map<Key, std::size_t> known;
    std::size_t texels_left = document.options.most_texels;
    for (std::size_t t = 0; t < of_texture.size(); ++t) {
        if (!used[t]) continue;
        const auto key = key_of(document, t);
        if (!key) return key.error();
        if (!*key) continue;
        const auto found = known.find(**key);
        if (found == known.end()) {
            auto texture = decode(document, **key, texels_left);
            if (!texture) return texture.error();
            texels_left -= texture->texels.size();
            known.emplace(**key, textures.size());
            textures.push_back(*std::move(texture));
        }
        of_texture[t] = known.at(**key);
    }
    return of_texture;
}

}  // namespace lobelia::gltf
