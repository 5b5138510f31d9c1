// Builds a binary glTF file.
#include "scene/gltf/glb_builder.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "io/json.h"
#include "scene/gltf/accessors.h"

namespace lobelia::gltf {
namespace {

using nlohmann::json;

constexpr int k_vertices = 34962, k_elements = 34963;  // bufferView.target

template <class T>
std::string_view bytes_of(std::span<const T> values) {
    return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

void pad(std::string& bytes, char with) { bytes.append((4 - bytes.size() % 4) % 4, with); }

void append_word(std::string& bytes, std::size_t value) {
    const auto word = static_cast<std::uint32_t>(value);
    bytes.append(reinterpret_cast<const char*>(&word), sizeof word);
}

}  // namespace

GlbBuilder::GlbBuilder() {
    root_["asset"] = {{"version", "2.0"}, {"generator", "Lobelia"}};
    root_["scene"] = 0;
}

std::size_t GlbBuilder::add(const char* array, json entry) {
    json& list = root_[array];
    list.push_back(std::move(entry));
    return list.size() - 1;
}

std::size_t GlbBuilder::add_view(std::string_view bytes, int target) {
    pad(binary_, '\0');
    json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}};
    if (target != 0) view["target"] = target;
    binary_.append(bytes);
    return add("bufferViews", std::move(view));
}

std::size_t GlbBuilder::add_accessor(std::string_view bytes, std::size_t count, json accessor, int target) {
    accessor["bufferView"] = add_view(bytes, target);
    accessor["count"] = count;
    return add("accessors", std::move(accessor));
}

std::size_t GlbBuilder::add_positions(std::span<const Vec3> values) {
    constexpr float far = std::numeric_limits<float>::max();
    Vec3 lowest{far, far, far}, highest{-far, -far, -far};
    for (const Vec3 p : values) {
        lowest = {std::min(lowest.x, p.x), std::min(lowest.y, p.y), std::min(lowest.z, p.z)};
        highest = {std::max(highest.x, p.x), std::max(highest.y, p.y), std::max(highest.z, p.z)};
    }
    return add_accessor(bytes_of(values), values.size(),
                        {{"componentType", k_float},
                         {"type", "VEC3"},
                         {"min", {lowest.x, lowest.y, lowest.z}},
                         {"max", {highest.x, highest.y, highest.z}}},
                        k_vertices);
}

std::size_t GlbBuilder::add_vectors(std::span<const Vec3> values) {
    return add_accessor(bytes_of(values), values.size(), {{"componentType", k_float}, {"type", "VEC3"}}, k_vertices);
}

std::size_t GlbBuilder::add_vectors(std::span<const Vec2> values) {
    return add_accessor(bytes_of(values), values.size(), {{"componentType", k_float}, {"type", "VEC2"}}, k_vertices);
}

std::size_t GlbBuilder::add_vectors(std::span<const std::array<float, 4>> values) {
    return add_accessor(bytes_of(values), values.size(), {{"componentType", k_float}, {"type", "VEC4"}}, k_vertices);
}

std::size_t GlbBuilder::add_indices(std::span<const std::uint32_t> values) {
    const bool small = std::all_of(values.begin(), values.end(), [](std::uint32_t v) { return v < 65535; });
    const json accessor = {{"componentType", small ? k_unsigned_short : k_unsigned_int}, {"type", "SCALAR"}};
    if (!small) return add_accessor(bytes_of(values), values.size(), accessor, k_elements);
    const std::vector<std::uint16_t> narrow(values.begin(), values.end());
    return add_accessor(bytes_of(std::span<const std::uint16_t>(narrow)), values.size(), accessor, k_elements);
}

Result<std::string> GlbBuilder::finish() {
    if (!extensions_.empty()) root_["extensionsUsed"] = extensions_;
    pad(binary_, '\0');
    if (!binary_.empty()) root_["buffers"] = json::array({{{"byteLength", binary_.size()}}});
    std::string text = json_text(root_);
    pad(text, ' ');

    // Write a header of 12 bytes, then each chunk after its length and type.
    const std::size_t size = 12 + 8 + text.size() + (binary_.empty() ? 0 : 8 + binary_.size());
    if (size > std::numeric_limits<std::uint32_t>::max())
        return Error{"the scene takes more than 4 GiB, which a .glb file cannot hold"};
    std::string file = "glTF";
    file.reserve(size);
    append_word(file, 2);
    append_word(file, size);
    append_word(file, text.size());
    file += "JSON" + text;
    if (!binary_.empty()) {
        append_word(file, binary_.size());
        file.append("BIN\0", 4);
        file += binary_;
    }
    return file;
}

}  // namespace lobelia::gltf
