// The baked scene as glTF, ready to be shown with its lightmaps.
#include "bake/write/scene_copy.h"

#include "bake/write/manifest.h"

#include <cassert>
#include <nlohmann/json.hpp>

#include "io/json.h"

namespace lobelia {

Result<std::string> encode_scene_copy(const Scene& scene, const Manifest& manifest,
                                      std::vector<GltfLightmap> lightmaps) {
    assert(scene.objects.size() == manifest.objects.size());
    using nlohmann::ordered_json;
    const Vec2 per_texel{1.0f / static_cast<float>(manifest.width), 1.0f / static_cast<float>(manifest.height)};
    GltfWriteOptions options;
    options.scene_extras = json_text(ordered_json{{"lobelia_bake", k_manifest_name}});
    options.extensions = "{\"LOBELIA_lightmap\":" + lightmap_extension_text(manifest) + "}";
    options.lightmaps = std::move(lightmaps);
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        std::string& extras = options.object_extras.emplace_back();
        std::string& extensions = options.object_extensions.emplace_back();
        std::vector<Vec2>& page_uv = options.lightmap_uv.emplace_back();
        auto& lightmap = options.object_lightmap.emplace_back();
        const AtlasPlacement& p = manifest.objects[i].placement;
        if (!p.baked) continue;
        if (!options.lightmaps.empty()) lightmap = p.page;
        extensions = json_text(ordered_json{{"LOBELIA_lightmap", {{"page", p.page}}}});
        extras =
            json_text(ordered_json{{"lobelia_lightmap", {{"page", p.page}, {"file", manifest.pages[p.page].file}}}});
        for (const Vec2 uv : scene.meshes[scene.objects[i].mesh].lightmap_uv)
            page_uv.push_back(
                {(p.scale.x * uv.x + p.offset.x) * per_texel.x, (p.scale.y * uv.y + p.offset.y) * per_texel.y});
    }
    return encode_glb(scene, options);
}

AtlasPlacement placement_in_copy(const Manifest& manifest, std::size_t object) {
    AtlasPlacement placement = manifest.objects[object].placement;
    placement.scale = {static_cast<float>(manifest.width), static_cast<float>(manifest.height)};
    placement.offset = {};
    return placement;
}

}  // namespace lobelia
