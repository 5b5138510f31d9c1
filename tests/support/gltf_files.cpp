// Small glTF files, made in memory.
#include "gltf_files.h"

#include "io/write_image.h"
#include "report/base64.h"

namespace lobelia {

using nlohmann::json;

namespace {

void append_word(std::string& bytes, std::size_t value) {
    const auto word = static_cast<std::uint32_t>(value);
    bytes.append(reinterpret_cast<const char*>(&word), sizeof word);
}

}  // namespace

std::string glb_of(std::string text, std::string binary) {
    text.append((4 - text.size() % 4) % 4, ' ');
    binary.append((4 - binary.size() % 4) % 4, '\0');
    std::string file = "glTF";
    append_word(file, 2);
    append_word(file, 20 + text.size() + (binary.empty() ? 0 : 8 + binary.size()));
    append_word(file, text.size());
    file += "JSON" + text;
    if (binary.empty()) return file;
    append_word(file, binary.size());
    file.append("BIN\0", 4);
    return file + binary;
}

std::size_t GltfFile::add(const char* array, json entry) {
    root[array].push_back(std::move(entry));
    return root[array].size() - 1;
}

std::size_t GltfFile::view(std::string_view bytes) {
    binary.append((4 - binary.size() % 4) % 4, '\0');
    const std::size_t offset = binary.size();
    binary += bytes;
    return add("bufferViews", {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes.size()}});
}

std::size_t GltfFile::accessor(std::size_t view, std::size_t count, int component_type, std::size_t components,
                               bool normalized) {
    constexpr std::array<const char*, 4> types{"SCALAR", "VEC2", "VEC3", "VEC4"};
    json entry = {
        {"bufferView", view}, {"count", count}, {"componentType", component_type}, {"type", types[components - 1]}};
    if (normalized) entry["normalized"] = true;
    return add("accessors", std::move(entry));
}

std::string GltfFile::gltf() const {
    json copy = root;
    if (!binary.empty())
        copy["buffers"] = json::array(
            {{{"byteLength", binary.size()}, {"uri", "data:application/octet-stream;base64," + base64(binary)}}});
    return copy.dump();
}

std::string GltfFile::glb() const {
    json copy = root;
    if (!binary.empty()) copy["buffers"] = json::array({{{"byteLength", binary.size()}}});
    return glb_of(copy.dump(), binary);
}

std::string small_png() {
    const std::vector<std::array<std::uint8_t, 4>> texels{
        {255, 0, 0, 255}, {0, 255, 0, 128}, {0, 0, 255, 0}, {10, 20, 30, 40}};
    return encode_png(2, 2, texels).value();
}

GltfFile square_file() {
    GltfFile file;
    const auto positions = file.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, 3);
    const auto indices = file.accessor(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, 1);
    file.add("meshes",
             {{"name", "square"}, {"primitives", {{{"attributes", {{"POSITION", positions}}}, {"indices", indices}}}}});
    file.add("nodes", {{"name", "square node"}, {"mesh", 0}});
    return file;
}

GltfFile rich_file() {
    GltfFile file = square_file();
    // A second mesh: a strip with quantised positions, normalised coordinates and colours, beside a fan.
    const auto strip = file.accessor(std::vector<std::int16_t>{0, 0, 0, 9, 9, 0, 0, 9, 0, 9, 0, 0, 9, 9, 0, 9}, 4);
    file.root["accessors"][strip]["type"] = "VEC3";
    file.root["bufferViews"].back()["byteStride"] = 8;
    const auto uv = file.accessor(std::vector<std::uint8_t>{0, 0, 255, 0, 0, 255, 255, 255}, 2, true);
    const auto colors =
        file.accessor(std::vector<std::uint16_t>{65535, 0, 0, 0, 65535, 0, 0, 0, 65535, 9, 9, 9}, 3, true);
    const auto sparse_view = file.view(std::vector<std::uint8_t>{1, 3});
    const auto values_view = file.view(std::vector<float>{1, 0, 0, 1, 1, 0});
    const auto sparse = file.add("accessors", {{"count", 4},
                                               {"componentType", 5126},
                                               {"type", "VEC3"},
                                               {"sparse",
                                                {{"count", 2},
                                                 {"indices", {{"bufferView", sparse_view}, {"componentType", 5121}}},
                                                 {"values", {{"bufferView", values_view}}}}}});
    const json attributes = {{"POSITION", strip}, {"TEXCOORD_0", uv}, {"TEXCOORD_1", uv}, {"COLOR_0", colors}};
    file.add("meshes", {{"primitives",
                         {{{"attributes", attributes}, {"mode", 5}, {"material", 0}},
                          {{"attributes", {{"POSITION", sparse}}}, {"mode", 6}, {"material", 1}},
                          {{"attributes", {{"POSITION", sparse}}}, {"mode", 1}}}}});

    // Two materials with all extensions that are read.
    file.add("images", {{"bufferView", file.view(small_png())}, {"mimeType", "image/png"}});
    file.add("images", {{"uri", "data:image/png;base64," + base64(small_png())}});
    file.add("samplers", {{"wrapS", 33071}, {"wrapT", 33648}});
    file.add("textures", {{"source", 0}, {"sampler", 0}});
    file.add("textures", {{"source", 1}});
    const json transform = {{"offset", {0.5, 0.25}}, {"rotation", 0.5}, {"scale", {2, 3}}, {"texCoord", 1}};
    file.add("materials",
             {{"alphaMode", "MASK"},
              {"alphaCutoff", 0.25},
              {"doubleSided", true},
              {"emissiveFactor", {1, 0.5, 0}},
              {"emissiveTexture", {{"index", 1}}},
              {"pbrMetallicRoughness",
               {{"baseColorFactor", {0.5, 0.6, 0.7, 0.8}},
                {"baseColorTexture", {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}}},
                {"metallicRoughnessTexture", {{"index", 1}}}}},
              {"extensions",
               {{"KHR_materials_emissive_strength", {{"emissiveStrength", 20}}},
                {"KHR_materials_ior", {{"ior", 1.33}}},
                {"KHR_materials_specular", {{"specularFactor", 0.5}, {"specularColorFactor", {1, 2, 3}}}}}}});
    file.add("materials", {{"alphaMode", "BLEND"}, {"extensions", {{"KHR_materials_unlit", json::object()}}}});

    // Nodes: a parent with two children, copies, three lights and a camera.
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"color", {1, 0.5, 0.25}}, {"intensity", 10}, {"range", 7}},
        {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.2}}}},
        {{"type", "directional"}, {"extras", {{"angular_radius", 0.005}}}}};
    const auto light = [](int i) -> json { return {{"KHR_lights_punctual", {{"light", i}}}}; };
    file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}});
    const auto copies = file.accessor(std::vector<float>{0, 0, 0, 5, 0, 0}, 3);
    file.add("nodes", {{"mesh", 1}, {"translation", {1, 2, 3}}, {"rotation", {0, 1, 0, 0}}, {"scale", {2, 2, 2}}});
    file.add("nodes",
             {{"mesh", 0}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", copies}}}}}}}});
    file.add("nodes", {{"children", {1, 2}}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 10, 0, 0, 1}}});
    for (int i = 0; i < 3; ++i) file.add("nodes", {{"extensions", light(i)}, {"name", "light"}});
    file.add("nodes", {{"camera", 0}, {"translation", {0, 0, 5}}});
    file.root["scenes"][0]["nodes"] = {0, 3, 4, 5, 6, 7};
    file.root["extensionsUsed"] = {"KHR_lights_punctual", "KHR_texture_transform"};
    return file;
}

}  // namespace lobelia
