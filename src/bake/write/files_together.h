// Several files of one folder, all complete before the first takes its place.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "io/folders.h"
#include "io/staged_file.h"

namespace lobelia {

/// Files that are staged together; unless they are committed, neither files nor folders made here are left behind.
class FilesTogether {
  public:
    /// Makes the folder if it is missing.
    /// No file is written on once `stop` becomes true: that is an error.
    [[nodiscard]] static Result<FilesTogether> in(const std::filesystem::path& folder, StopFlag stop = {});

    /// Adds a file that `write(StagedFile&)` fills; `write` returns a Status.
    template <class Write>
    [[nodiscard]] Status add(const std::string& name, const Write& write) {
        auto file = StagedFile::create(folder_ / name, stop_);
        if (!file) return file.error();
        if (Status status = write(*file); !status) return status;
        if (Status status = file->flush(); !status) return status;
        // Keep few files open: a process may hold a limited number.
        constexpr std::size_t k_most_open = 64;
        if (files_.size() >= k_most_open)
            if (Status status = file->close(); !status) return status;
        files_.push_back(*std::move(file));
        return Done{};
    }
    [[nodiscard]] StopFlag stop() const { return stop_; }
    [[nodiscard]] Status add_text(const std::string& name, std::string_view text);
    /// Puts the files in place, in the order in which they were added.
    [[nodiscard]] Status commit();

  private:
    FilesTogether(std::filesystem::path folder, MadeFolder made, StopFlag stop)
        : folder_(std::move(folder)), made_(std::move(made)), stop_(stop) {}

    std::filesystem::path folder_;
    MadeFolder made_;  ///< before the files: they are removed first
    StopFlag stop_;
    std::vector<StagedFile> files_;
};

}  // namespace lobelia
