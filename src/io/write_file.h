// Files that are written whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

#include "lobelia/result.h"

namespace lobelia {

/// Writes `bytes` to `path` under a temporary name in the same folder, flushes them to the disk and renames; on failure
/// the old content is untouched and the temporary is gone. A symbolic link is replaced, not followed (StagedFile);
/// pipes and devices, those behind /dev/stdout too, are written to directly. Errors name the file and the cause: no
/// such folder, no permission, full.
[[nodiscard]] Status write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes);
[[nodiscard]] Status write_file_atomically(const std::filesystem::path& path, std::string_view text);

struct FileContent {
    std::filesystem::path path;
    std::string_view text;
};

/// Writes several files so that none changes unless all could be written: each is complete under its temporary name
/// before the first is renamed.
[[nodiscard]] Status write_files_together(std::span<const FileContent> files);

}  // namespace lobelia
