// Output folders: checked before long work, made when needed, removed again when the work fails.
#pragma once

#include <filesystem>
#include <span>

#include "io/write_file.h"

namespace lobelia {

/// Checks that files can be written into the folder, which need not exist yet. Call it before long work.
[[nodiscard]] Status check_folder(const std::filesystem::path& folder);
/// Checks that a file of that name can be written: its folder exists and allows it. Call it before long work.
[[nodiscard]] Status check_file(const std::filesystem::path& file);

/// A folder that is made if it is missing, with the folders above it. Unless kept, the folders made here are removed
/// again, as far as they are empty.
class MadeFolder {
  public:
    [[nodiscard]] static Result<MadeFolder> make(const std::filesystem::path& folder);
    MadeFolder(MadeFolder&& other) noexcept;
    MadeFolder& operator=(MadeFolder&&) = delete;
    ~MadeFolder();
    void keep() { topmost_.clear(); }

  private:
    MadeFolder(std::filesystem::path folder, std::filesystem::path topmost)
        : folder_(std::move(folder)), topmost_(std::move(topmost)) {}
    std::filesystem::path folder_, topmost_;  ///< topmost_: the outermost folder made here; empty: none
};

/// Makes the folder if it is missing, and writes all files or none; on failure, folders made here are removed again.
[[nodiscard]] Status write_into_folder(const std::filesystem::path& folder, std::span<const FileContent> files);

}  // namespace lobelia
