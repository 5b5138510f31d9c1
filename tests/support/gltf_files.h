// Small glTF files, made in memory for the tests and as seeds for the fuzzer.
#pragma once

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace lobelia {

/// JSON and a binary buffer, which becomes the file's only one.
struct GltfFile {
    nlohmann::json root = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}};
    std::string binary;

    /// Adds a bufferView of these bytes; returns its index.
    std::size_t view(std::string_view bytes);
    template <class T>
    std::size_t view(const std::vector<T>& values) {
        return view({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
    }
    /// Adds an accessor of these values, `components` each; returns its index.
    template <class T>
    std::size_t accessor(const std::vector<T>& values, std::size_t components, bool normalized = false) {
        return accessor(view(values), values.size() / components, component_type(T{}), components, normalized);
    }
    std::size_t accessor(std::size_t view, std::size_t count, int component_type, std::size_t components,
                         bool normalized = false);
    /// Appends to an array of the root; returns the index there.
    std::size_t add(const char* array, nlohmann::json entry);

    /// Returns the file as text, with the buffer as a data URI, and as .glb.
    [[nodiscard]] std::string gltf() const;
    [[nodiscard]] std::string glb() const;

    static int component_type(std::int8_t) { return 5120; }
    static int component_type(std::uint8_t) { return 5121; }
    static int component_type(std::int16_t) { return 5122; }
    static int component_type(std::uint16_t) { return 5123; }
    static int component_type(std::uint32_t) { return 5125; }
    static int component_type(float) { return 5126; }
};

/// A square of two triangles on one node, in the xy plane from (0, 0) to (1, 1), facing +z, without a material.
[[nodiscard]] GltfFile square_file();

/// A file with most kinds of content: textures, all kinds of lights, instances, strips, sparse and quantised accessors.
[[nodiscard]] GltfFile rich_file();

/// The bytes of a PNG of 2 x 2 texels.
[[nodiscard]] std::string small_png();

/// Wraps any JSON text and binary chunk in the .glb container.
[[nodiscard]] std::string glb_of(std::string json, std::string binary);

}  // namespace lobelia
