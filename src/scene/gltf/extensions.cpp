// glTF extensions: supported, ignored with a warning, or refused.
#include "scene/gltf/extensions.h"

#include <algorithm>
#include <array>

namespace lobelia::gltf {
namespace {

constexpr std::string_view k_copy = "decompress the file first: gltf-transform copy IN.glb OUT.glb";
constexpr std::string_view k_png = "convert its textures first: gltf-transform png IN.glb OUT.glb --formats \"*\"";
constexpr std::string_view k_fallback = "its textures are read from their PNG, JPEG or WebP fallbacks only";
constexpr std::string_view k_plain = "compressed data is not supported; its fallback is read";

/// An extension, and the reader's behaviour.
struct Extension {
    std::string_view name;
    enum class Support { full, harmless, fallback, none } support;
    std::string_view warning = {};  ///< for files that use it; empty: none
    std::string_view remedy = {};   ///< for files that require it
};
using Support = Extension::Support;

constexpr std::array k_extensions{
    Extension{"KHR_lights_punctual", Support::full}, Extension{"KHR_materials_emissive_strength", Support::full},
    Extension{"KHR_materials_ior", Support::full}, Extension{"KHR_materials_specular", Support::full},
    Extension{"KHR_materials_unlit", Support::full}, Extension{"KHR_mesh_quantization", Support::full},
    Extension{"KHR_node_visibility", Support::full}, Extension{"KHR_texture_transform", Support::full},
    Extension{"EXT_mesh_gpu_instancing", Support::full}, Extension{"EXT_texture_webp", Support::full},
    // Extensions that do not affect the bake, or only add alternatives.
    Extension{"KHR_materials_variants", Support::harmless}, Extension{"KHR_xmp", Support::harmless},
    Extension{"KHR_xmp_json_ld", Support::harmless}, Extension{"KHR_animation_pointer", Support::harmless},
    Extension{"MSFT_lod", Support::harmless}, Extension{"MSFT_packing_occlusionRoughnessMetallic", Support::harmless},
    Extension{"MSFT_packing_normalRoughnessMetallic", Support::harmless},
    Extension{"EXT_mesh_features", Support::harmless}, Extension{"EXT_structural_metadata", Support::harmless},
    Extension{"LOBELIA_lightmap", Support::harmless}, Extension{"MOZ_lightmap", Support::harmless},
    Extension{"CESIUM_primitive_outline", Support::harmless}, Extension{"FB_geometry_metadata", Support::harmless},
    // Extensions with a fallback; files without it are refused where it is needed.
    Extension{"EXT_texture_avif", Support::fallback, k_fallback, k_png},
    Extension{"MSFT_texture_dds", Support::fallback, k_fallback, k_png},
    Extension{"KHR_texture_basisu", Support::fallback, k_fallback,
              "convert its textures first: gltf-transform ktxdecompress IN.glb OUT.glb"},
    Extension{"KHR_draco_mesh_compression", Support::fallback, k_plain, k_copy},
    Extension{"EXT_meshopt_compression", Support::fallback, k_plain, k_copy},
    Extension{"KHR_meshopt_compression", Support::fallback, k_plain, k_copy},
    Extension{"KHR_materials_pbrSpecularGlossiness", Support::none, {}, k_metalrough}};

Extension of_name(std::string_view name) {
    const auto found = std::find_if(k_extensions.begin(), k_extensions.end(),
                                    [&](const Extension& known) { return known.name == name; });
    if (found != k_extensions.end()) return *found;
    return {name, Support::none, "not supported", "export the file without it"};
}

constexpr std::size_t k_most_extensions = 4096;

}  // namespace

void check_extensions(Document& document, const JsonPlace& root) {
    if (const auto required = root.find("extensionsRequired"))
        for (const JsonPlace& entry : required->list(k_most_extensions)) {
            const Extension known = of_name(entry.long_text());
            if (known.support != Support::full && known.support != Support::harmless)
                document.refuse("extensionsRequired",
                                fmt::format("{:.60} is not supported; {}", known.name, known.remedy));
        }
    if (const auto used = root.find("extensionsUsed"))
        for (const JsonPlace& entry : used->list(k_most_extensions))
            if (const Extension known = of_name(entry.long_text()); !known.warning.empty())
                document.warn("extensionsUsed", fmt::format("{:.60}: {}", known.name, known.warning));
}

}  // namespace lobelia::gltf
