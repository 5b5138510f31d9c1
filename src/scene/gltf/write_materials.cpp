// Writes materials and textures into a glTF file.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>

#include "io/write_image.h"
#include "scene/gltf/write_materials.h"

namespace lobelia::gltf {
namespace {

using nlohmann::json;

int wrap_mode(Texture::Wrap wrap) {
    switch (wrap) {
        case Texture::Wrap::mirror:
            return 33648;
        case Texture::Wrap::clamp:
            return 33071;
        case Texture::Wrap::repeat:
            break;
    }
    return 10497;
}

int filter_mode(Texture::Filter filter) { return filter == Texture::Filter::nearest ? 9728 : 9729; }

/// Writes a texture's use as textureInfo. Errors: a transform that KHR_texture_transform cannot express.
Result<json> texture_info(GlbBuilder& builder, const TextureUse& use, const WriteSets& sets) {
    json info = {{"index", use.texture}};
    const std::size_t set = use.uv_set == 0 ? 0 : sets.second_uv;
    if (set != 0) info["texCoord"] = set;
    const auto& m = use.uv_from_mesh;
    if (m == TextureUse{}.uv_from_mesh) return info;

    // Decompose rotation times scale: the columns are (c sx, -s sx) and (s sy, c sy).
    const double a = m[0][0], b = m[0][1], c = m[1][0], d = m[1][1];
    const double scale_x = std::hypot(a, c);
    const double angle = scale_x > 0 ? std::atan2(-c, a) : std::atan2(b, d);
    const double scale_y = std::sin(angle) * b + std::cos(angle) * d;
    if (std::abs(std::cos(angle) * b - std::sin(angle) * d) > 1e-5 * (std::abs(scale_y) + scale_x))
        return Error{fmt::format("a use of texture {} shears it, which glTF cannot express", use.texture)};
    json transform;
    if (m[0][2] != 0 || m[1][2] != 0) transform["offset"] = {m[0][2], m[1][2]};
    if (angle != 0) transform["rotation"] = angle;
    if (scale_x != 1 || scale_y != 1) transform["scale"] = {scale_x, scale_y};
    info["extensions"]["KHR_texture_transform"] = transform;
    builder.use_extension("KHR_texture_transform");
    return info;
}

/// Writes emission. Colour factors may not exceed 1; the rest goes into a common strength.
void write_emission(GlbBuilder& builder, const Material& m, json& out) {
    const double strength = std::max({1.0f, m.emission.r, m.emission.g, m.emission.b});
    if (m.emission == Rgb{}) return;
    out["emissiveFactor"] = {m.emission.r / strength, m.emission.g / strength, m.emission.b / strength};
    if (strength == 1) return;
    out["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", strength}};
    builder.use_extension("KHR_materials_emissive_strength");
}

void write_extensions(GlbBuilder& builder, const Material& m, json& out) {
    const auto extension = [&](const char* name) -> json& {
        builder.use_extension(name);
        return out["extensions"][name] = json::object();
    };
    if (m.unlit) extension("KHR_materials_unlit");
    if (m.ior != Material{}.ior) extension("KHR_materials_ior")["ior"] = m.ior;
    if (m.specular == 1 && m.specular_color == Rgb{1, 1, 1}) return;
    json& specular = extension("KHR_materials_specular");
    if (m.specular != 1) specular["specularFactor"] = m.specular;
    if (m.specular_color != Rgb{1, 1, 1})
        specular["specularColorFactor"] = {m.specular_color.r, m.specular_color.g, m.specular_color.b};
}

Result<json> material(GlbBuilder& builder, const Material& m, const WriteSets& sets) {
    json pbr, out;
    if (!m.name.empty()) out["name"] = m.name;
    if (m.base_color != Rgb{1, 1, 1} || m.alpha != 1)
        pbr["baseColorFactor"] = {m.base_color.r, m.base_color.g, m.base_color.b, m.alpha};
    if (m.metallic != 1) pbr["metallicFactor"] = m.metallic;
    if (m.roughness != 1) pbr["roughnessFactor"] = m.roughness;
    write_emission(builder, m, out);
    write_extensions(builder, m, out);
    if (m.alpha_mode == Material::Alpha::mask) out["alphaMode"] = "MASK";
    if (m.alpha_mode == Material::Alpha::blend) out["alphaMode"] = "BLEND";
    if (m.alpha_mode == Material::Alpha::mask && m.alpha_cutoff != 0.5f) out["alphaCutoff"] = m.alpha_cutoff;
    if (m.double_sided) out["doubleSided"] = true;
    const auto write_use = [&](const std::optional<TextureUse>& use, json& target, const char* key) -> Status {
        if (!use) return Done{};
        auto info = texture_info(builder, *use, sets);
        if (!info) return info.error();
        target[key] = *std::move(info);
        return Done{};
    };
    if (auto s = write_use(m.base_color_texture, pbr, "baseColorTexture"); !s) return s.error();
    if (auto s = write_use(m.metallic_roughness_texture, pbr, "metallicRoughnessTexture"); !s) return s.error();
    if (auto s = write_use(m.emissive_texture, out, "emissiveTexture"); !s) return s.error();
    out["pbrMetallicRoughness"] = pbr.is_null() ? json::object() : pbr;
    return out;
}

}  // namespace

Status write_materials(GlbBuilder& builder, const Scene& scene, const WriteSets& sets) {
    for (const Material& m : scene.materials) {
        auto written = material(builder, m, sets);
        if (!written) return Error{fmt::format("material \"{}\": {}", m.name, written.error().message)};
        builder.add("materials", *std::move(written));
    }
    return Done{};
}

Status write_textures(GlbBuilder& builder, const Scene& scene) {
    std::map<std::tuple<int, int, int>, std::size_t> samplers;
    for (const Texture& texture : scene.textures) {
        const auto png = encode_png(texture.width, texture.height, texture.texels);
        if (!png) return Error{fmt::format("texture \"{}\": {}", texture.name, png.error().message)};
        json image = {{"bufferView", builder.add_view(*png, 0)}, {"mimeType", "image/png"}};
        if (!texture.name.empty()) image["name"] = texture.name;
        const int u = wrap_mode(texture.wrap_u), v = wrap_mode(texture.wrap_v), filter = filter_mode(texture.filter);
        auto sampler = samplers.find({u, v, filter});
        if (sampler == samplers.end()) {
            const std::size_t index =
                builder.add("samplers", {{"wrapS", u}, {"wrapT", v}, {"magFilter", filter}, {"minFilter", filter}});
            sampler = samplers.emplace(std::tuple{u, v, filter}, index).first;
        }
        builder.add("textures", {{"source", builder.add("images", std::move(image))}, {"sampler", sampler->second}});
    }
    return Done{};
}

}  // namespace lobelia::gltf
