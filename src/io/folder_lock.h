// One writer at a time in an output folder.
#pragma once

#include <filesystem>
#include <memory>

#include "io/descriptor.h"
#include "io/folders.h"

namespace lobelia {

/// The right to write into a folder, until it is destroyed or the process ends, however that may be: the kernel holds
/// it (flock) on a file in the folder, in which the owner's process, host and time are written. File systems without
/// such locks are written to without one.
class FolderLock {
  public:
    /// Makes the folder if it is missing; it is removed again with the lock if it is empty then. An error that names
    /// the owner and the age of its lock if another process, or another lock of this one, holds it.
    [[nodiscard]] static Result<std::shared_ptr<const FolderLock>> take(const std::filesystem::path& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  private:
    FolderLock(std::filesystem::path folder, MadeFolder made, io::Descriptor file);

    std::filesystem::path folder_;
    MadeFolder made_;
    io::Descriptor file_;
};

}  // namespace lobelia
