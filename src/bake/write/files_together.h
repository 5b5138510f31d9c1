// Several files of one folder that take their places in one step.
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>

#include "io/commit_journal.h"
#include "io/folder_lock.h"
#include "io/staged_file.h"
#include "lobelia/bake.h"

namespace lobelia {

/// Files that are staged together, under the folder's lock. Unless they are committed, neither files nor folders made
/// here are left behind; once they are, readers see all of them (CommittedFolder), whenever the process is killed.
class FilesTogether {
  public:
    /// Makes the folder if it is missing, and locks it (lock_folder). Once `stop` becomes true, adding files is an
    /// error.
    [[nodiscard]] static Result<FilesTogether> in(const std::filesystem::path& folder, StopFlag stop = {});
    explicit FilesTogether(std::shared_ptr<const FolderLock> lock, StopFlag stop = {})
        : lock_(std::move(lock)), stop_(stop) {}

    /// Adds a file that `write(StagedFile&)` fills; `write` returns a Status. The name may have one folder in it.
    template <class Write>
    [[nodiscard]] Status add(const std::string& name, const Write& write) {
        if (Status status = make_parent(name); !status) return status;
        auto file = StagedFile::create(lock_->folder() / name, stop_);
        if (!file) return file.error();
        if (Status status = write(*file); !status) return status;
        return take(name, *std::move(file));
    }
    [[nodiscard]] StopFlag stop() const { return stop_; }
    [[nodiscard]] Status add_text(const std::string& name, std::string_view text);
    /// Removes a file with the commit, if it is there then.
    void remove(const std::string& name) { removals_.push_back(name); }
    [[nodiscard]] const std::filesystem::path& folder() const { return lock_->folder(); }
    /// Returns size and checksum of each file added so far.
    [[nodiscard]] const std::vector<FileEntry>& entries() const { return entries_; }

    /// Puts the files in place.
    [[nodiscard]] Status commit();

  private:
    [[nodiscard]] Status make_parent(const std::string& name);
    [[nodiscard]] Status take(const std::string& name, StagedFile file);

    std::shared_ptr<const FolderLock> lock_;
    StopFlag stop_;
    std::vector<MadeFolder> made_;  ///< before the files: they are removed first
    std::vector<StagedFile> files_;
    std::vector<FileEntry> entries_;  ///< one for each file
    std::vector<std::string> removals_;
};

}  // namespace lobelia
