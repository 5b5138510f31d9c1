// Folders made for outputs, which disappear again if nothing is written into them.
#pragma once

#include <filesystem>
#include <vector>

#include "lobelia/result.h"

namespace lobelia {

/// A folder with all those above it. Unless kept, the destructor removes those that `make` created, if they are empty.
class OutputFolder {
  public:
    /// Creates the folder and the missing ones above it. Errors name the folder and the cause; nothing is left then.
    [[nodiscard]] static Result<OutputFolder> make(const std::filesystem::path& path);
    OutputFolder(OutputFolder&& other) noexcept;
    OutputFolder& operator=(OutputFolder&&) = delete;
    ~OutputFolder();

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    /// Keeps all folders, even if they are empty.
    void keep() { created_.clear(); }

  private:
    explicit OutputFolder(std::filesystem::path path) : path_(std::move(path)) {}

    std::filesystem::path path_;
    std::vector<std::filesystem::path> created_;  ///< outermost first
};

}  // namespace lobelia
