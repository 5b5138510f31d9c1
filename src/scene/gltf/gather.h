// A glTF file with all files that it refers to, for programs that would open them without checks.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "lobelia/result.h"

namespace lobelia::gltf {

/// The file's JSON, whose URIs are "data:" URIs or names of `files`. These names are not the file's own.
struct GatheredFile {
    std::string json;
    std::vector<std::pair<std::string, std::vector<std::byte>>> files;
};

/// Reads a .gltf or .glb file and everything that its buffers and images refer to, as read_gltf does: files in its own
/// folder or below, no links that lead out of it. Errors name the file and the place in its JSON.
[[nodiscard]] Result<GatheredFile> gather_gltf(const std::filesystem::path& path, std::size_t most_bytes);

}  // namespace lobelia::gltf
