// Several files of one folder, all complete before the first takes its place.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "io/staged_file.h"

namespace lobelia {

/// Unless committed it leaves nothing behind: no file, nor a folder that it made.
class FilesTogether {
  public:
    /// Makes the folder if it is missing.
    [[nodiscard]] static Result<FilesTogether> in(const std::filesystem::path& folder);
    FilesTogether(FilesTogether&& other) noexcept;
    FilesTogether& operator=(FilesTogether&&) = delete;
    ~FilesTogether();

    /// A file that `write(StagedFile&)` fills, which returns a Status.
    template <class Write>
    [[nodiscard]] Status add(const std::string& name, const Write& write) {
        auto file = StagedFile::create(folder_ / name);
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
    FilesTogether(std::filesystem::path folder, std::filesystem::path made)
        : folder_(std::move(folder)), made_(std::move(made)) {}

    std::filesystem::path folder_;
    std::filesystem::path made_;  ///< the folder, if it is new and still to be removed
    std::vector<StagedFile> files_;
};

}  // namespace lobelia
