// A file whose new content grows beside it and takes its place at once, or not at all.
#pragma once

#include <cstdint>
#include <string_view>

#include "io/descriptor.h"
#include "io/file_sum.h"

namespace lobelia {

/// Holds the new content beside the file until `commit` puts it in place. Where the system supports it, the content has
/// no name before that, so that nothing is left behind if the process is killed; else the destructor removes it. While
/// it is open it is locked (flock), so that remove_abandoned_files leaves it alone. Errors name the file and the cause:
/// no such folder, no permission, full.
class StagedFile {
  public:
    /// A symbolic link at the path: `followed` replaces the file that it leads to, `replaced` the link itself.
    enum class Links { followed, replaced };
    /// Starts an empty file for `path`; permissions of the file that it will replace are kept. An error if `path` is a
    /// folder, pipe or device.
    [[nodiscard]] static Result<StagedFile> create(const std::filesystem::path& path, Links links = Links::followed);
    StagedFile(StagedFile&& other) noexcept;
    StagedFile& operator=(StagedFile&&) = delete;
    ~StagedFile();

    /// Writes at the end, or at the position set by `seek`.
    [[nodiscard]] Status write(std::span<const std::byte> bytes);
    [[nodiscard]] Status seek(std::uint64_t position);
    /// Flushes all of it to the disk: only then is it certain that there is room for it.
    [[nodiscard]] Status flush();
    /// Returns size and checksum of the content, after `flush` and before `close`.
    [[nodiscard]] Result<FileSum> sum() const;
    /// Closes it, after `flush`, if many are staged at once; it has a temporary name from then on.
    [[nodiscard]] Status close();
    /// Puts it in place, after `flush`.
    [[nodiscard]] Status commit();
    /// Returns the temporary name, after `close`.
    [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }
    /// Leaves the file under its temporary name: somebody else puts it in place.
    void release() { temporary_.clear(); }

  private:
    StagedFile(std::filesystem::path target, io::Descriptor descriptor, std::filesystem::path temporary);
    /// Gives it its temporary name.
    [[nodiscard]] Status name();

    std::filesystem::path target_;
    io::Descriptor descriptor_;
    std::filesystem::path temporary_;  ///< its name until it is in place; empty while it has none
};

/// Returns whether a file name is one of those that staged files have before they are in place.
[[nodiscard]] bool is_temporary_name(std::string_view name);

/// Removes the files with temporary names that killed processes left in a folder. Files that a process holds open stay.
/// Call it under the folder's lock: files staged together are closed before they are in place.
void remove_abandoned_files(const std::filesystem::path& folder);

}  // namespace lobelia
