// Several files of one folder, all complete before the first takes its place.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "io/output_folder.h"
#include "io/staged_file.h"

namespace lobelia {

/// Unless committed it leaves nothing behind: no file, and no folder that it created.
class FilesTogether {
  public:
    /// Creates the folder if it is missing, with those above it.
    [[nodiscard]] static Result<FilesTogether> in(const std::filesystem::path& folder);

    /// A file that `write(StagedFile&)` fills, which returns a Status.
    template <class Write>
    [[nodiscard]] Status add(const std::string& name, const Write& write) {
        auto file = StagedFile::create(folder_.path() / name);
        if (!file) return file.error();
        if (Status status = write(*file); !status) return status;
        if (Status status = file->flush(); !status) return status;
        // A process may not hold many files open.
        constexpr std::size_t k_most_open = 64;
        if (files_.size() >= k_most_open)
            if (Status status = file->close(); !status) return status;
        files_.push_back(*std::move(file));
        return Done{};
    }
    [[nodiscard]] Status add_text(const std::string& name, std::string_view text);
    /// Puts them in place, in the order in which they were added.
    [[nodiscard]] Status commit();

  private:
    explicit FilesTogether(OutputFolder folder) : folder_(std::move(folder)) {}

    // Destroyed after the files in it.
    OutputFolder folder_;
    std::vector<StagedFile> files_;
};

}  // namespace lobelia
