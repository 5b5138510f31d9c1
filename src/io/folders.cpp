// Output folders.
#include "io/folders.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace lobelia {

namespace fs = std::filesystem;

Status check_folder(const fs::path& folder) {
    // Check the folder, or the nearest existing one above it.
    std::error_code code;
    fs::path existing = fs::absolute(folder, code);
    while (!fs::exists(existing, code) && existing.has_relative_path()) existing = existing.parent_path();
    if (!fs::is_directory(existing, code))
        return Error{folder.string() + ": cannot create the folder: " + existing.string() + " is not a folder"};
    if (access(existing.c_str(), W_OK | X_OK) != 0)
        return Error{folder.string() + ": cannot be written to: " + std::generic_category().message(errno)};
    return Done{};
}

Status check_file(const fs::path& file) {
    std::error_code code;
    const fs::path folder = fs::absolute(file, code).parent_path();
    if (!fs::is_directory(folder, code))
        return Error{file.string() + ": cannot be written: there is no folder " + folder.string()};
    if (access(folder.c_str(), W_OK | X_OK) != 0)
        return Error{file.string() + ": cannot be written: " + std::generic_category().message(errno)};
    return Done{};
}

Result<MadeFolder> MadeFolder::make(const fs::path& folder) {
    // Find the outermost folder that is missing.
    std::error_code code;
    fs::path whole = fs::absolute(folder, code);
    if (!whole.has_filename()) whole = whole.parent_path();
    fs::path topmost;
    for (fs::path at = whole; at.has_relative_path() && !fs::exists(at, code); at = at.parent_path()) topmost = at;
    MadeFolder made(whole, topmost);
    fs::create_directories(whole, code);
    if (!code && !fs::is_directory(whole, code)) code = std::make_error_code(std::errc::not_a_directory);
    if (code) return Error{fmt::format("{}: cannot create the folder: {}", folder.string(), code.message())};
    return made;
}

MadeFolder::MadeFolder(MadeFolder&& other) noexcept
    : folder_(std::move(other.folder_)), topmost_(std::exchange(other.topmost_, {})) {}

MadeFolder::~MadeFolder() {
    if (topmost_.empty()) return;
    std::error_code code;
    // Folders that were not made, or hold something, stay.
    for (fs::path at = folder_; fs::remove(at, code), at != topmost_;) at = at.parent_path();
}

Status write_into_folder(const fs::path& folder, std::span<const FileContent> files) {
    auto made = MadeFolder::make(folder);
    if (!made) return made.error();
    if (auto status = write_files_together(files); !status) return status;
    made->keep();
    return Done{};
}

}  // namespace lobelia
