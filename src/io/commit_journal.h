// Files that take their places together: a journal of the renamings makes them one step for readers, and lets the next
// writer complete them if the process is killed between two.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lobelia/result.h"

namespace lobelia {

/// Renamings of complete files to their final names, and files to remove. Names are relative to the folder, with at
/// most one folder in them; those to rename have temporary names (staged_file.h).
struct CommitJournal {
    struct Rename {
        std::string from, to;
    };
    std::vector<Rename> renames;
    std::vector<std::string> removals;
};

/// How a commit ended that could not be completed.
struct CommitFailure {
    Error error;
    bool begun = false;  ///< the journal is in place: the files belong to it now
};

/// Writes the journal into the folder, renames, removes, and removes the journal. From the moment at which the journal
/// is there, CommittedFolder and finish_commit see all of it. Precondition: the files are flushed.
[[nodiscard]] std::optional<CommitFailure> commit(const std::filesystem::path& folder, const CommitJournal& journal);

/// Completes a commit that was interrupted in the folder, if there is one. Call it under the folder's lock.
[[nodiscard]] Status finish_commit(const std::filesystem::path& folder);

/// A folder as the last commit in it is or will be, for readers, who write nothing.
class CommittedFolder {
  public:
    /// Reads the journal, if there is one. An error if it is not one of Lobelia's.
    [[nodiscard]] static Result<CommittedFolder> open(const std::filesystem::path& folder);

    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
    /// Returns where the content of a file is now: under its temporary name while it waits for its place.
    [[nodiscard]] std::filesystem::path path(const std::string& name) const;

  private:
    std::filesystem::path folder_;
    CommitJournal journal_;
};

}  // namespace lobelia
