// The lock of a bake's folder, and the order in which it is taken over from a process that was killed.
#include "bake/session/checkpoint.h"
#include "io/commit_journal.h"
#include "io/folder_lock.h"
#include "io/staged_file.h"
#include "lobelia/bake.h"

namespace lobelia {

Result<std::shared_ptr<const FolderLock>> lock_folder(const std::filesystem::path& folder) {
    auto lock = FolderLock::take(folder);
    if (!lock) return lock;
    // Complete an interrupted commit first: it needs the files with temporary names that the next step would remove.
    if (auto status = finish_commit(folder); !status) return status.error();
    std::error_code code;
    if (const auto checkpoint = checkpoint_folder(folder); std::filesystem::is_symlink(checkpoint, code))
        return Error{checkpoint.string() +
                     ": a symbolic link; checkpoints are written into the bake's own folder only"};
    remove_abandoned_files(folder);
    remove_abandoned_files(checkpoint_folder(folder));
    return lock;
}

}  // namespace lobelia
