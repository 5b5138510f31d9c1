// A file whose new content grows beside it and takes its place at once, or not at all.
#pragma once

#include <cstdint>

#include "io/descriptor.h"

namespace lobelia {

/// The content is complete beside the file until `commit` puts it in place. Where the system can, it has no name before
/// that, so that nothing is left of it if the process is ended; else the destructor removes it. Errors name the file
/// and the cause: no such folder, no permission, full.
class StagedFile {
  public:
    /// An empty one for `path`: links are followed, permissions of the file that it will replace are kept. What is
    /// there and is no regular file is refused.
    [[nodiscard]] static Result<StagedFile> create(const std::filesystem::path& path);
    StagedFile(StagedFile&& other) noexcept;
    StagedFile& operator=(StagedFile&&) = delete;
    ~StagedFile();

    /// At the end of what was written, or where `seek` led.
    [[nodiscard]] Status write(std::span<const std::byte> bytes);
    [[nodiscard]] Status seek(std::uint64_t position);
    /// Brings all of it to the disk: only then is it certain that there is room for it.
    [[nodiscard]] Status flush();
    /// Closes it, after `flush`, where many are staged at once; it then has a temporary name even if unnamed before.
    [[nodiscard]] Status close();
    /// Puts it in place, after `flush`.
    [[nodiscard]] Status commit();

  private:
    StagedFile(std::filesystem::path target, io::Descriptor descriptor, std::filesystem::path temporary);

    std::filesystem::path target_;
    io::Descriptor descriptor_;
    std::filesystem::path temporary_;  ///< its name until it is in place; empty while it has none
};

/// Removes what processes that were killed have left of staged files in the folder, which need not exist: a file has a
/// temporary name for a moment before it gets its own.
void remove_abandoned_files(const std::filesystem::path& folder);

}  // namespace lobelia
