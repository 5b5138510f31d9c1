// Textures of a glTF file: images, wrapping and filtering.
#include "io/read_picture.h"
#include "scene/gltf/materials.h"

namespace lobelia::gltf {
namespace {

// sampler.wrapS, sampler.magFilter
constexpr std::size_t k_repeat = 10497, k_mirror = 33648, k_clamp = 33071;
constexpr std::size_t k_nearest = 9728, k_linear = 9729;

constexpr std::size_t k_bytes_per_texel = 4;

/// Textures of the file with equal keys become one.
struct Key {
    std::size_t image = 0;
    Texture::Wrap wrap_u = Texture::Wrap::repeat, wrap_v = Texture::Wrap::repeat;
    Texture::Filter filter = Texture::Filter::linear;
    auto operator<=>(const Key&) const = default;
};

Texture::Wrap read_wrap(const JsonPlace& sampler, const char* key) {
    const auto found = sampler.find(key);
    const std::size_t mode = found ? whole(*found) : k_repeat;
    if (mode != k_repeat && mode != k_mirror && mode != k_clamp) sampler.refuse("neither repeat, mirror nor clamp");
    return mode == k_clamp ? Texture::Wrap::clamp : mode == k_mirror ? Texture::Wrap::mirror : Texture::Wrap::repeat;
}

void read_sampler(const Document& document, const JsonPlace& texture, Key& key) {
    const auto index = find_index(texture, "sampler", document.samplers.size());
    if (!index) return;
    const JsonPlace& sampler = document.samplers[*index];
    key.wrap_u = read_wrap(sampler, "wrapS");
    key.wrap_v = read_wrap(sampler, "wrapT");
    const auto filter = sampler.find("magFilter");
    if (!filter) return;
    const std::size_t mode = whole(*filter);
    if (mode != k_nearest && mode != k_linear) filter->refuse("neither NEAREST nor LINEAR");
    if (mode == k_nearest) key.filter = Texture::Filter::nearest;
}

/// Returns the image of a texture: its own, or that of EXT_texture_webp; nothing if the file specifies none. Refuses a
/// texture whose only image has an unsupported format, like a missing file: it may light the scene.
std::optional<std::size_t> find_image(Document& document, const JsonPlace& texture) {
    if (const auto source = find_index(texture, "source", document.images.size())) return source;
    if (const auto webp = extension(texture, "EXT_texture_webp"))
        return index_below(webp->at("source"), document.images.size());
    if (const auto extensions = texture.find("extensions"); extensions && extensions->size() > 0)
        texture.refuse(
            fmt::format("its only image is in {:.60}, which is not supported; convert it first: gltf-transform "
                        "png IN.glb OUT.glb --formats \"*\" (ktxdecompress for KHR_texture_basisu)",
                        extensions->members().front().first));
    document.warn(texture, "no image; left out");
    return std::nullopt;
}

/// Returns the bytes of an image's file.
Bytes image_bytes(Document& document, const JsonPlace& image) {
    if (const auto view = image.find("bufferView")) return view_bytes(document, *view);
    const JsonPlace uri = image.at("uri");
    const auto bytes = document.resources.get(std::string(uri.long_text()));
    if (!bytes) uri.refuse(bytes.error().message);
    return *bytes;
}

Texture decode(Document& document, const Key& key, std::size_t most_texels) {
    const JsonPlace& image = document.images[key.image];
    document.stop().check();
    const Bytes bytes = image_bytes(document, image);
    const std::size_t memory = document.scene_memory() - std::min(document.scene_memory(), document.kept_bytes);
    auto picture = read_picture_rgba8(bytes, fmt::format("{}: images[{}]", document.json.file(), key.image),
                                      std::min(most_texels, memory / k_bytes_per_texel));
    if (!picture) throw JsonRefusal(picture.error().message);
    document.keep(image, picture->texels.size(), k_bytes_per_texel);
    Texture texture;
    texture.name = name_of(image);
    texture.width = picture->width;
    texture.height = picture->height;
    texture.texels = std::move(picture->texels);
    texture.wrap_u = key.wrap_u;
    texture.wrap_v = key.wrap_v;
    texture.filter = key.filter;
    return texture;
}

}  // namespace

std::vector<std::optional<std::size_t>> read_textures(Document& document, const std::vector<bool>& used,
                                                      std::vector<Texture>& textures) {
    std::vector<std::optional<std::size_t>> of_texture(document.textures.size());
    std::map<Key, std::size_t> known;
    std::size_t texels_left = document.options.most_texels;
    for (std::size_t t = 0; t < of_texture.size(); ++t) {
        if (!used[t]) continue;
        const auto image = find_image(document, document.textures[t]);
        if (!image) continue;
        Key key{.image = *image};
        read_sampler(document, document.textures[t], key);
        const auto [entry, is_new] = known.emplace(key, textures.size());
        of_texture[t] = entry->second;
        if (!is_new) continue;
        textures.push_back(decode(document, key, texels_left));
        texels_left -= textures.back().texels.size();
    }
    return of_texture;
}

}  // namespace lobelia::gltf
