// Reading glTF from memory in tests.
#pragma once

#include <gtest/gtest.h>

#include "gltf_files.h"
#include "lobelia/gltf.h"

namespace lobelia::test {

inline Result<LoadedScene> read_gltf_text(const std::string& bytes, const GltfReadOptions& options = {}) {
    return read_gltf(std::as_bytes(std::span(bytes)), "test.glb", {}, options);
}

/// Returns the scene, or fails the test.
inline Scene scene_of_gltf(const GltfFile& file, const GltfReadOptions& options = {}) {
    auto text = read_gltf_text(file.gltf(), options), binary = read_gltf_text(file.glb(), options);
    EXPECT_TRUE(text) << text.error().message;
    EXPECT_TRUE(binary) << binary.error().message;
    return text ? text->scene : Scene{};
}

inline std::string gltf_error(const std::string& bytes, const GltfReadOptions& options = {}) {
    const auto result = read_gltf_text(bytes, options);
    return result ? "read without an error" : result.error().message;
}

inline testing::AssertionResult says(const std::string& text, std::string_view part) {
    if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
    return testing::AssertionFailure() << "\"" << text << "\" lacks \"" << part << "\"";
}

}  // namespace lobelia::test
