// Materials of a glTF file: metallic-roughness and the extensions that change reflection or emission.
#include "scene/gltf/materials.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/math/colour.h"
#include "scene/gltf/extensions.h"
#include "scene/gltf/nodes.h"

namespace lobelia::gltf {
namespace {

/// A reference of a material to a texture of the file.
struct Reference {
    std::size_t texture = 0;    ///< index in the file
    std::size_t tex_coord = 0;  ///< TEXCOORD set
    TextureUse use;
};

/// A material before its textures and uv sets have their indices in the scene.
struct Draft {
    Material material;
    std::optional<Reference> base_color, metallic_roughness, emissive;
};

/// Reads KHR_texture_transform: offset, then rotation, then scale, as one matrix.
void read_transform(const JsonPlace& source, Reference& reference) {
    std::array<double, 2> offset{0, 0}, scale{1, 1};
    if (const auto found = source.find("offset")) found->numbers(offset);
    if (const auto found = source.find("scale")) found->numbers(scale);
    const double angle = number_or(source, "rotation", 0), c = std::cos(angle), s = std::sin(angle);
    const std::array<std::array<double, 3>, 2> rows{
        {{c * scale[0], s * scale[1], offset[0]}, {-s * scale[0], c * scale[1], offset[1]}}};
    for (std::size_t row = 0; row < 2; ++row)
        for (std::size_t k = 0; k < 3; ++k) {
            reference.use.uv_from_mesh[row][k] = static_cast<float>(rows[row][k]);
            if (!std::isfinite(reference.use.uv_from_mesh[row][k])) source.refuse("not finite");
        }
    if (const auto set = source.find("texCoord")) reference.tex_coord = whole(*set);
}

std::optional<Reference> read_reference(const Document& document, const JsonPlace& owner, const char* key) {
    const auto info = owner.find(key);
    if (!info) return std::nullopt;
    Reference reference;
    reference.texture = index_below(info->at("index"), document.textures.size());
    if (const auto set = info->find("texCoord")) reference.tex_coord = whole(*set);
    if (const auto transform = extension(*info, "KHR_texture_transform")) read_transform(*transform, reference);
    return reference;
}

/// Returns a factor that glTF limits to [0, 1], clamped to it with a warning.
float clamped_factor(Document& document, double value, const JsonPlace& place) {
    if (value >= 0 && value <= 1) return static_cast<float>(value);
    document.warn(place, fmt::format("{} is not in [0, 1]; clamped", value));
    return value > 1 ? 1.0f : 0.0f;
}

float factor_or(Document& document, const JsonPlace& object, const char* key, float otherwise) {
    const auto found = object.find(key);
    return found ? clamped_factor(document, found->number(), *found) : otherwise;
}

void read_emission(const Document& document, const JsonPlace& source, Material& material) {
    double strength = 1;
    if (const auto extended = extension(source, "KHR_materials_emissive_strength"))
        strength = number_or(*extended, "emissiveStrength", 1);
    if (document.options.units == GltfReadOptions::Units::photometric) strength /= k_white_efficacy;
    std::array<double, 3> color{0, 0, 0};
    if (const auto found = source.find("emissiveFactor")) found->numbers(color);
    material.emission = light_amount(source, color, strength, "emission");
}

void read_specular(Document& document, const JsonPlace& source, Material& material) {
    if (const auto extended = extension(source, "KHR_materials_ior")) {
        const double ior = number_or(*extended, "ior", 1.5);
        if (!(ior == 0 || (ior >= 1 && ior < 1e6))) extended->refuse(fmt::format("{}: neither 0 nor at least 1", ior));
        material.ior = static_cast<float>(ior);
    }
    const auto extended = extension(source, "KHR_materials_specular");
    if (!extended) return;
    material.specular = factor_or(document, *extended, "specularFactor", 1);
    if (const auto color = extended->find("specularColorFactor")) {
        const Vec3 c = color->vector();
        if (c.x < 0 || c.y < 0 || c.z < 0) color->refuse("negative");
        material.specular_color = {c.x, c.y, c.z};
    }
    if (extended->has("specularTexture") || extended->has("specularColorTexture"))
        document.warn(*extended, "its textures are not supported; only the factors are used");
}

void read_alpha(const JsonPlace& source, Material& material) {
    if (const auto mode = source.find("alphaMode")) {
        const std::string_view text = mode->long_text();
        if (text == "MASK") {
            material.alpha_mode = Material::Alpha::mask;
        } else if (text == "BLEND") {
            material.alpha_mode = Material::Alpha::blend;
        } else if (text != "OPAQUE") {
            mode->refuse("neither OPAQUE, MASK nor BLEND");
        }
    }
    if (const auto cutoff = source.find("alphaCutoff")) {
        material.alpha_cutoff = cutoff->single();
        if (material.alpha_cutoff < 0) cutoff->refuse("negative");
    }
}

void read_metallic_roughness(Document& document, const JsonPlace& source, Draft& draft) {
    Material& material = draft.material;
    material.metallic = 1;
    const auto pbr = source.find("pbrMetallicRoughness");
    if (!pbr) return;
    if (const auto found = pbr->find("baseColorFactor")) {
        std::array<double, 4> values{};
        found->numbers(values);
        const auto factor = [&](std::size_t i) { return clamped_factor(document, values[i], *found); };
        material.base_color = {factor(0), factor(1), factor(2)};
        material.alpha = factor(3);
    }
    material.metallic = factor_or(document, *pbr, "metallicFactor", 1);
    material.roughness = factor_or(document, *pbr, "roughnessFactor", 1);
    draft.base_color = read_reference(document, *pbr, "baseColorTexture");
    draft.metallic_roughness = read_reference(document, *pbr, "metallicRoughnessTexture");
}

Draft read_draft(Document& document, const JsonPlace& source) {
    if (extension(source, "KHR_materials_pbrSpecularGlossiness"))
        source.refuse(fmt::format("KHR_materials_pbrSpecularGlossiness is not supported; {}", k_metalrough));
    Draft draft;
    Material& material = draft.material;
    material.name = name_of(source);
    if (const auto flag = source.find("doubleSided")) material.double_sided = flag->flag();
    material.unlit = extension(source, "KHR_materials_unlit").has_value();
    read_metallic_roughness(document, source, draft);
    read_emission(document, source, material);
    read_specular(document, source, material);
    read_alpha(source, material);
    draft.emissive = read_reference(document, source, "emissiveTexture");
    return draft;
}

/// Warns once about an unsupported map: the number of materials that have it, the first of them, and the consequence.
void warn_of_maps(Document& document, const char* key, std::string_view maps, std::string_view consequence) {
    std::size_t count = 0, first = 0;
    for (std::size_t i = 0; i < document.materials.size(); ++i)
        if (document.materials[i].has(key) && count++ == 0) first = i;
    if (count == 0) return;
    document.warn("materials", fmt::format("{} with {}, the first materials[{}] \"{}\": {}", count, maps, first,
                                           name_of(document.materials[first]), consequence));
}

/// Chooses uv sets: 0 and 1 keep their numbers; if others are used, the lowest two become 0 and 1.
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

/// Converts a reference to the scene's indices; nothing if its texture or uv set was left out.
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

UvSets read_materials(Document& document, Scene& scene) {
    std::vector<Draft> drafts;
    for (const JsonPlace& material : document.materials) drafts.push_back(read_draft(document, material));
    warn_of_maps(document, "normalTexture", "normal maps", "not supported; surfaces use their vertex normals");
    warn_of_maps(document, "occlusionTexture", "occlusion maps", "not used; path tracing computes occlusion");

    // Decode the textures that are used, and choose the uv sets.
    std::vector<bool> used(document.textures.size());
    std::set<std::size_t> sets;
    for (Draft& draft : drafts)
        for (const auto* reference : {&draft.base_color, &draft.metallic_roughness, &draft.emissive})
            if (*reference) {
                used[(*reference)->texture] = true;
                sets.insert((*reference)->tex_coord);
            }
    const auto of_texture = read_textures(document, used, scene.textures);
    const UvSets uv_sets = choose_sets(document, sets);

    // Replace the references by the scene's indices.
    for (Draft& draft : drafts) {
        draft.material.base_color_texture = numbered(draft.base_color, of_texture, uv_sets);
        draft.material.metallic_roughness_texture = numbered(draft.metallic_roughness, of_texture, uv_sets);
        draft.material.emissive_texture = numbered(draft.emissive, of_texture, uv_sets);
        scene.materials.push_back(std::move(draft.material));
    }
    return uv_sets;
}

}  // namespace lobelia::gltf
