// A file whose new content grows beside it and takes its place at once, or not at all.
#pragma once

#include <cstdint>
#include <string_view>

#include <filesystem>

#include "core/stop.h"
#include "io/descriptor.h"
#include "io/file_sum.h"

namespace lobelia {

/// Holds the new content beside the file until `commit` puts it in place. Where the system supports it, the content has
/// no name before that, so that nothing is left behind if the process is killed; else the destructor removes it. While
/// it is open it is locked (flock), so that remove_abandoned_files leaves it alone. Errors name the file and the cause:
/// no such folder, no permission, full.
class StagedFile {
  public:
    /// Starts an empty file for `path`; permissions of the file that it will replace are kept. A symbolic link is
    /// replaced itself, not the file that it leads to: whoever can put a link into a folder must not choose what is
    /// overwritten. (The system's own links, /dev/stdout, are followed.) An error if `path` is a folder, pipe or
    /// device. Once `stop` is set, writing is an error.
    [[nodiscard]] static Result<StagedFile> create(const std::filesystem::path& path, StopFlag stop = {});
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
    StagedFile(std::filesystem::path target, io::Descriptor descriptor, std::filesystem::path temporary, StopFlag stop);
    /// Gives it its temporary name.
    [[nodiscard]] Status name();

    std::filesystem::path target_;
    io::Descriptor descriptor_;
    std::filesystem::path temporary_;  ///< its name until it is in place; empty while it has none
    StopFlag stop_;
};

/// Returns where a file named `path` is written: the end of the system's own links, /dev/stdout and the like; every
/// other link is the place itself. An error if links lead in a circle.
[[nodiscard]] Result<std::filesystem::path> place_of_output(std::filesystem::path path);

/// Returns whether a file name is one of those that staged files have before they are in place.
[[nodiscard]] bool is_temporary_name(std::string_view name);

/// Removes the files with temporary names that killed processes left in a folder. Files that a process holds open stay.
/// Call it under the folder's lock: files staged together are closed before they are in place.
void remove_abandoned_files(const std::filesystem::path& folder);

}  // namespace lobelia
