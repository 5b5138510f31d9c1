// Materials of a glTF file: metallic-roughness and the extensions that change reflection or emission.
#include "scene/gltf_materials.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/math/colour.h"
#include "scene/gltf_textures.h"

namespace lobelia::gltf {
namespace {

/// A texture as a material of the file refers to it.
struct Reference {
    std::size_t texture = 0;    ///< of the file
    std::size_t tex_coord = 0;  ///< TEXCOORD set
    TextureUse use;
};

/// What a material is before textures and uv sets have their numbers in the scene.
struct Draft {
    Material material;
    std::optional<Reference> base_color, metallic_roughness, emissive;
};

/// KHR_texture_transform: offset, then rotation, then scale, as one matrix.
Status read_transform(const Document& document, const tinygltf::Value& value, Reference& reference,
                      const std::string& place) {
    const auto pair = [&](const char* key, double otherwise) {
        const tinygltf::Value& array = value.Get(key);
        std::array<double, 2> result{otherwise, otherwise};
        for (int i = 0; i < 2 && array.IsArray() && array.ArrayLen() == 2; ++i)
            if (array.Get(i).IsNumber()) result[static_cast<std::size_t>(i)] = array.Get(i).GetNumberAsDouble();
        return result;
    };
    const auto offset = pair("offset", 0), scale = pair("scale", 1);
    const double angle = number(value, "rotation", 0), c = std::cos(angle), s = std::sin(angle);
    const std::array<std::array<double, 3>, 2> rows{
        {{c * scale[0], s * scale[1], offset[0]}, {-s * scale[0], c * scale[1], offset[1]}}};
    for (std::size_t row = 0; row < 2; ++row)
        for (std::size_t k = 0; k < 3; ++k) {
            reference.use.uv_from_mesh[row][k] = static_cast<float>(rows[row][k]);
            if (!std::isfinite(reference.use.uv_from_mesh[row][k])) return document.error(place, "not finite");
        }
    const auto set = checked_index(document, value, "texCoord", 1 << 16, place);
    if (!set) return set.error();
    if (*set) reference.tex_coord = **set;
    return Done{};
}

Result<std::optional<Reference>> read_reference(const Document& document, const tinygltf::TextureInfo& info,
                                                const std::string& place) {
    if (info.index < 0) return std::optional<Reference>();
    if (static_cast<std::size_t>(info.index) >= document.model.textures.size())
        return document.error(place + ".index", fmt::format("{} of {}", info.index, document.model.textures.size()));
    Reference reference{static_cast<std::size_t>(info.index), static_cast<std::size_t>(std::max(info.texCoord, 0)), {}};
    if (const auto* transform = extension(info.extensions, "KHR_texture_transform"))
        if (const Status s =
                read_transform(document, *transform, reference, place + ".extensions.KHR_texture_transform");
            !s)
            return s.error();
    return std::optional<Reference>(reference);
}

/// A factor that glTF limits to [0, 1], cut to that with a warning.
float factor(Document& document, double value, std::string_view place) {
    if (value >= 0 && value <= 1) return static_cast<float>(value);
    document.warn(place, fmt::format("{} is not in [0, 1]; cut to that", value));
    return value > 1 ? 1.0f : 0.0f;
}

Status read_emission(Document& document, const tinygltf::Material& source, Material& material,
                     const std::string& place) {
    double strength = 1;
    if (const auto* value = extension(source.extensions, "KHR_materials_emissive_strength"))
        strength = number(*value, "emissiveStrength", 1);
    if (document.options.units == GltfReadOptions::Units::photometric) strength /= k_white_efficacy;
    std::array<float, 3> rgb{};
    for (std::size_t i = 0; i < 3 && i < source.emissiveFactor.size(); ++i)
        rgb[i] = static_cast<float>(source.emissiveFactor[i] * strength);
    for (const float x : rgb)
        if (!(x >= 0) || !std::isfinite(x))
            return document.error(place,
                                  fmt::format("its emission ({}, {}, {}) is no radiance", rgb[0], rgb[1], rgb[2]));
    material.emission = {rgb[0], rgb[1], rgb[2]};
    return Done{};
}

Status read_specular(Document& document, const tinygltf::Material& source, Material& material,
                     const std::string& place) {
    if (const auto* value = extension(source.extensions, "KHR_materials_ior")) {
        const double ior = number(*value, "ior", 1.5);
        if (!(ior == 0 || (ior >= 1 && ior < 1e6)))
            return document.error(place + ".extensions.KHR_materials_ior",
                                  fmt::format("{}: neither 0 nor at least 1", ior));
        material.ior = static_cast<float>(ior);
    }
    const auto* value = extension(source.extensions, "KHR_materials_specular");
    if (value == nullptr) return Done{};
    const std::string at = place + ".extensions.KHR_materials_specular";
    material.specular = factor(document, number(*value, "specularFactor", 1), at + ".specularFactor");
    const tinygltf::Value& color = value->Get("specularColorFactor");
    std::array<float, 3> rgb{1, 1, 1};
    for (int i = 0; i < 3 && color.IsArray() && color.ArrayLen() == 3; ++i)
        if (color.Get(i).IsNumber())
            rgb[static_cast<std::size_t>(i)] = static_cast<float>(color.Get(i).GetNumberAsDouble());
    for (const float x : rgb)
        if (!(x >= 0) || !std::isfinite(x))
            return document.error(at + ".specularColorFactor", "negative or not finite");
    material.specular_color = {rgb[0], rgb[1], rgb[2]};
    if (value->Has("specularTexture") || value->Has("specularColorTexture"))
        document.warn(at, "its textures are not read, only the factors");
    return Done{};
}

Status read_alpha(Document& document, const tinygltf::Material& source, Material& material, const std::string& place) {
    if (source.alphaMode == "MASK") {
        material.alpha_mode = Material::Alpha::mask;
    } else if (source.alphaMode == "BLEND") {
        material.alpha_mode = Material::Alpha::blend;
    } else if (source.alphaMode != "OPAQUE") {
        return document.error(place + ".alphaMode", "neither OPAQUE, MASK nor BLEND");
    }
    material.alpha_cutoff = static_cast<float>(source.alphaCutoff);
    if (!(material.alpha_cutoff >= 0) || !std::isfinite(material.alpha_cutoff))
        return document.error(place + ".alphaCutoff", "negative or not finite");
    return Done{};
}

Result<Draft> read_draft(Document& document, const tinygltf::Material& source, const std::string& place) {
    // Factors.
    Draft draft;
    Material& material = draft.material;
    material.name = short_name(source.name);
    material.double_sided = source.doubleSided;
    material.unlit = extension(source.extensions, "KHR_materials_unlit") != nullptr;
    const auto& pbr = source.pbrMetallicRoughness;
    const std::string at = place + ".pbrMetallicRoughness";
    std::array<float, 4> color{1, 1, 1, 1};
    for (std::size_t i = 0; i < 4 && i < pbr.baseColorFactor.size(); ++i)
        color[i] = factor(document, pbr.baseColorFactor[i], at + ".baseColorFactor");
    material.base_color = {color[0], color[1], color[2]};
    material.alpha = color[3];
    material.metallic = factor(document, pbr.metallicFactor, at + ".metallicFactor");
    material.roughness = factor(document, pbr.roughnessFactor, at + ".roughnessFactor");
    if (const Status s = read_emission(document, source, material, place); !s) return s.error();
    if (const Status s = read_specular(document, source, material, place); !s) return s.error();
    if (const Status s = read_alpha(document, source, material, place); !s) return s.error();

    // Textures.
    const auto read = [&](std::optional<Reference>& target, const tinygltf::TextureInfo& info,
                          const std::string& where) -> Status {
        auto reference = read_reference(document, info, where);
        if (!reference) return reference.error();
        target = *reference;
        return Done{};
    };
    if (const Status s = read(draft.base_color, pbr.baseColorTexture, at + ".baseColorTexture"); !s) return s.error();
    if (const Status s = read(draft.metallic_roughness, pbr.metallicRoughnessTexture, at + ".metallicRoughnessTexture");
        !s)
        return s.error();
    if (const Status s = read(draft.emissive, source.emissiveTexture, place + ".emissiveTexture"); !s) return s.error();
    return draft;
}

/// Says how many materials have a map that is left out, which is the first, and what that means.
void warn_of_maps(Document& document, int index_of(const tinygltf::Material&), std::string_view maps,
                  std::string_view consequence) {
    std::size_t count = 0, first = 0;
    const auto& materials = document.model.materials;
    for (std::size_t i = 0; i < materials.size(); ++i)
        if (index_of(materials[i]) >= 0 && count++ == 0) first = i;
    if (count == 0) return;
    document.warn("materials", fmt::format("{} with {}, the first materials[{}] \"{}\": {}", count, maps, first,
                                           short_name(materials[first].name), consequence));
}

void warn_of_unread_maps(Document& document) {
    warn_of_maps(
        document, [](const tinygltf::Material& m) { return m.normalTexture.index; }, "normal maps",
        "not read; surfaces have the normals of their vertices");
    warn_of_maps(
        document, [](const tinygltf::Material& m) { return m.occlusionTexture.index; }, "occlusion maps",
        "not read; the paths find what hides what");
}

/// Sets 0 and 1 keep their numbers; where others are used, the lowest two become 0 and 1.
UvSets choose_sets(Document& document, const std::set<std::size_t>& used) {
    UvSets sets;
    if (used.empty()) return sets;
    if (*used.rbegin() <= 1) {
        for (const std::size_t set : used) sets.set[set] = set;
        return sets;
    }
    std::size_t next = 0;
    for (const std::size_t set : used)
        if (next < 2) sets.set[next++] = set;
    if (used.size() > 2)
        document.warn("materials", fmt::format("textures use {} sets of texture coordinates; only TEXCOORD_{} and _{} "
                                               "are read",
                                               used.size(), *sets.set[0], *sets.set[1]));
    return sets;
}

/// A reference by the scene's numbers; nothing where its texture or uv set was left out.
std::optional<TextureUse> numbered(const std::optional<Reference>& reference,
                                   const std::vector<std::optional<std::size_t>>& of_texture, const UvSets& uv_sets) {
    if (!reference || !of_texture[reference->texture]) return std::nullopt;
    const auto set = std::find(uv_sets.set.begin(), uv_sets.set.end(), reference->tex_coord);
    if (set == uv_sets.set.end()) return std::nullopt;
    TextureUse use = reference->use;
    use.texture = *of_texture[reference->texture];
    use.uv_set = static_cast<std::size_t>(set - uv_sets.set.begin());
    return use;
}

}  // namespace

Result<UvSets> read_materials(Document& document, Scene& scene) {
    // Read what the file says.
    std::vector<Draft> drafts;
    for (std::size_t i = 0; i < document.model.materials.size(); ++i) {
        auto draft = read_draft(document, document.model.materials[i], fmt::format("materials[{}]", i));
        if (!draft) return draft.error();
        drafts.push_back(*std::move(draft));
    }

    warn_of_unread_maps(document);

    // Decode the textures that are used, and choose the uv sets.
    std::vector<bool> used(document.model.textures.size());
    std::set<std::size_t> sets;
    for (Draft& draft : drafts)
        for (const auto* reference : {&draft.base_color, &draft.metallic_roughness, &draft.emissive})
            if (*reference) {
                used[(*reference)->texture] = true;
                sets.insert((*reference)->tex_coord);
            }
    const auto of_texture = read_textures(document, used, scene.textures);
    if (!of_texture) return of_texture.error();
    const UvSets uv_sets = choose_sets(document, sets);

    // Number them in the materials.
    for (Draft& draft : drafts) {
        draft.material.base_color_texture = numbered(draft.base_color, *of_texture, uv_sets);
        draft.material.metallic_roughness_texture = numbered(draft.metallic_roughness, *of_texture, uv_sets);
        draft.material.emissive_texture = numbered(draft.emissive, *of_texture, uv_sets);
        scene.materials.push_back(std::move(draft.material));
    }
    return uv_sets;
}

}  // namespace lobelia::gltf
