// Bakes as arguments.
#pragma once

#include <filesystem>
#include <string>

namespace lobelia::cli {

/// Returns whether a path names a bake: its folder, or the bake.json in it.
[[nodiscard]] inline bool is_bake(const std::string& path) {
    std::error_code code;
    return std::filesystem::is_directory(path, code) || std::filesystem::path(path).filename() == "bake.json";
}

}  // namespace lobelia::cli
