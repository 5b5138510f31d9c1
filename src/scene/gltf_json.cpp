// The JSON of a glTF file, checked before anything is made of it.
#include "scene/gltf_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

namespace lobelia::gltf {
namespace {

using nlohmann::json;

/// Files in use stay below 20; the parsers that follow are recursive in places.
constexpr int k_deepest = 64;

/// How deep brackets nest in a JSON text, whether it is valid or not.
int depth_of(std::string_view text) {
    int depth = 0, deepest = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string) {
            if (c == '\\') ++i;
            if (c == '"') in_string = false;
        } else if (c == '"') {
            in_string = true;
        } else if (c == '{' || c == '[') {
            deepest = std::max(deepest, ++depth);
        } else if (c == '}' || c == ']') {
            --depth;
        }
    }
    return deepest;
}

constexpr std::array<std::string_view, 21> k_read{
    "KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_materials_ior", "KHR_materials_specular",
    "KHR_materials_unlit", "KHR_mesh_quantization", "KHR_texture_transform", "EXT_mesh_gpu_instancing",
    // These change nothing that is baked, or only add a choice.
    "KHR_materials_variants", "KHR_xmp", "KHR_xmp_json_ld", "KHR_animation_pointer", "MSFT_lod",
    "MSFT_packing_occlusionRoughnessMetallic", "MSFT_packing_normalRoughnessMetallic", "EXT_mesh_features",
    "EXT_structural_metadata", "CESIUM_primitive_outline", "FB_geometry_metadata", "EXT_texture_webp",
    "MSFT_texture_dds"};
/// Of those: fallbacks exist where they are not required.
constexpr std::array<std::string_view, 2> k_not_if_required{"EXT_texture_webp", "MSFT_texture_dds"};

bool contains(auto& names, std::string_view name) { return std::find(names.begin(), names.end(), name) != names.end(); }

/// What helps where a required extension is not read.
std::string_view remedy(std::string_view extension) {
    if (extension == "KHR_draco_mesh_compression" || extension == "EXT_meshopt_compression" ||
        extension == "KHR_meshopt_compression")
        return "decompress the file first: gltf-transform copy IN.glb OUT.glb";
    if (extension == "KHR_texture_basisu")
        return "convert its textures first: gltf-transform ktxdecompress IN.glb OUT.glb";
    if (extension == "EXT_texture_webp" || extension == "EXT_texture_avif")
        return "convert its textures first: gltf-transform png IN.glb OUT.glb --formats \"*\"";
    return "export the file without it";
}

Status check_extensions(const json& root, std::string_view name) {
    if (!root.contains("extensionsRequired")) return Done{};
    for (const json& entry : root["extensionsRequired"]) {
        if (!entry.is_string()) return Error{fmt::format("{}: extensionsRequired: an entry is not a name", name)};
        const auto& extension = entry.get_ref<const std::string&>();
        if (!contains(k_read, extension) || contains(k_not_if_required, extension))
            return Error{fmt::format("{}: extensionsRequired: {} is not read; {}", name, extension, remedy(extension))};
    }
    return Done{};
}

/// Members whose values index or count something.
bool is_whole_number(std::string_view key) {
    constexpr std::array<std::string_view, 21> keys{
        "scene",      "mesh",       "camera",     "skin",          "material", "indices", "mode",
        "bufferView", "byteOffset", "byteLength", "componentType", "count",    "buffer",  "byteStride",
        "target",     "source",     "sampler",    "index",         "texCoord", "wrapS",   "wrapT"};
    return contains(keys, key);
}

/// Finds a value of the wrong kind, for tinygltf passes over many. Extensions and extras are left alone.
Status check_kinds(const json& value, std::string_view name, const std::string& place) {
    if (value.is_array()) {
        for (std::size_t i = 0; i < value.size(); ++i)
            if (value[i].is_structured())
                if (auto s = check_kinds(value[i], name, fmt::format("{}[{}]", place, i)); !s) return s;
        return Done{};
    }
    for (auto entry = value.begin(); entry != value.end(); ++entry) {
        const std::string& key = entry.key();
        const json& member = entry.value();
        if (key == "extensions" || key == "extras") continue;
        const auto at = [&] { return (place.empty() ? "" : place + ".") + key.substr(0, 60); };
        // "indices" is a number in a primitive, an object in a sparse accessor; "target" an object in an animation.
        const bool may_be_object = key == "indices" || key == "target";
        if (is_whole_number(key) && !(may_be_object && member.is_object()) &&
            !(member.is_number_unsigned() && member.get<std::uint64_t>() <= std::numeric_limits<int>::max()) &&
            !(key.starts_with("byte") && member.is_number_unsigned()))
            return Error{fmt::format("{}: {}: not a whole number of fewer than 32 bits", name, at())};
        if (key == "name" && !member.is_string()) return Error{fmt::format("{}: {}: not a text", name, at())};
        if (member.is_structured())
            if (auto s = check_kinds(member, name, at()); !s) return s;
    }
    return Done{};
}

/// The top level: arrays of objects, and the version.
Status check_root(const json& root, std::string_view name) {
    if (!root.is_object()) return Error{fmt::format("{}: not a glTF file: its JSON is no object", name)};
    const json* asset = root.contains("asset") ? &root["asset"] : nullptr;
    if (!asset || !asset->is_object() || !asset->contains("version") || !(*asset)["version"].is_string())
        return Error{fmt::format("{}: asset.version: missing; not a glTF 2.0 file", name)};
    const auto& version = (*asset)["version"].get_ref<const std::string&>();
    if (!version.starts_with("2."))
        return Error{fmt::format("{}: asset.version: glTF \"{}\" is not read, 2.0 is", name, version.substr(0, 20))};
    constexpr std::array<std::string_view, 11> k_objects{"buffers",  "bufferViews", "accessors", "meshes",
                                                         "nodes",    "scenes",      "materials", "images",
                                                         "textures", "samplers",    "cameras"};
    for (const std::string_view key : k_objects) {
        if (!root.contains(key)) continue;
        const json& array = root[std::string(key)];
        if (!array.is_array()) return Error{fmt::format("{}: {}: not an array", name, key)};
        for (std::size_t i = 0; i < array.size(); ++i)
            if (!array[i].is_object()) return Error{fmt::format("{}: {}[{}]: not an object", name, key, i)};
    }
    for (const char* key : {"extensionsUsed", "extensionsRequired"})
        if (root.contains(key) && !root[key].is_array()) return Error{fmt::format("{}: {}: not an array", name, key)};
    return Done{};
}

}  // namespace

Result<json> parse_json(std::string_view text, std::string_view name) {
    if (depth_of(text) > k_deepest)
        return Error{fmt::format("{}: the JSON nests more than {} levels deep", name, k_deepest)};
    try {
        json root = json::parse(text);
        if (const Status s = check_root(root, name); !s) return s.error();
        if (const Status s = check_extensions(root, name); !s) return s.error();
        if (const Status s = check_kinds(root, name, ""); !s) return s.error();
        return root;
    } catch (const json::exception& error) {
        // "[json.exception.parse_error.101] parse error at line 1, column 5: ...": without what stands in brackets.
        const std::string_view what = error.what();
        const std::size_t bracket = what.find("] ");
        return Error{fmt::format("{}: not a glTF file: {}", name,
                                 what.substr(bracket == std::string_view::npos ? 0 : bracket + 2, 200))};
    }
}

std::string_view unread_extension(std::string_view extension) {
    if (extension == "KHR_texture_basisu") return "its textures are read from their PNG or JPEG fallbacks only";
    if (extension == "EXT_texture_webp" || extension == "MSFT_texture_dds" || extension == "EXT_texture_avif")
        return "its textures are read from their PNG or JPEG fallbacks only";
    if (extension == "KHR_draco_mesh_compression" || extension == "EXT_meshopt_compression" ||
        extension == "KHR_meshopt_compression")
        return "compressed data is not read, only its fallback";
    if (extension == "KHR_node_visibility") return "not read; hidden nodes are there, too";
    if (contains(k_read, extension)) return "";
    return "not read";
}

}  // namespace lobelia::gltf
