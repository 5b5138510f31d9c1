// The files of a bake's folder for readers: each checked against bake.json before it is read.
#pragma once

#include <filesystem>
#include <string>

#include "io/commit_journal.h"
#include "lobelia/bake.h"

namespace lobelia {

class BakeFiles {
  public:
    /// Opens the folder for a manifest that was read from it. Both must outlive the object.
    BakeFiles(const CommittedFolder& folder, const Manifest& manifest) : folder_(folder), manifest_(manifest) {}

    /// Returns the path to read a file from. An error if it is missing, a symbolic link or not a regular file, or if
    /// size or checksum are not those in the manifest; files without an entry there are not summed.
    [[nodiscard]] Result<std::filesystem::path> checked(const std::string& name) const;

  private:
    const CommittedFolder& folder_;
    const Manifest& manifest_;
};

}  // namespace lobelia
