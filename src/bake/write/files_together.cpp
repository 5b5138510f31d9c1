// Several files of one folder that take their places in one step.
#include "bake/write/files_together.h"

namespace lobelia {

Result<FilesTogether> FilesTogether::in(const std::filesystem::path& folder, StopFlag stop) {
    auto lock = lock_folder(folder);
    return lock ? Result<FilesTogether>(FilesTogether(*std::move(lock), stop)) : lock.error();
}

Status FilesTogether::add_text(const std::string& name, std::string_view text) {
    return add(name, [&](StagedFile& file) { return file.write(std::as_bytes(std::span(text))); });
}

Status FilesTogether::make_parent(const std::string& name) {
    const auto parent = std::filesystem::path(name).parent_path();
    if (parent.empty()) return Done{};
    auto made = MadeFolder::make(lock_->folder() / parent);
    if (!made) return made.error();
    made_.push_back(*std::move(made));
    return Done{};
}

Status FilesTogether::take(const std::string& name, StagedFile file) {
    if (Status status = file.flush(); !status) return status;
    const auto sum = file.sum();
    if (!sum) return sum.error();
    // Keep few files open: a process may hold a limited number.
    constexpr std::size_t k_most_open = 64;
    if (files_.size() >= k_most_open)
        if (Status status = file.close(); !status) return status;
    files_.push_back(std::move(file));
    entries_.push_back({name, sum->size, sum->crc32});
    return Done{};
}

Status FilesTogether::commit() {
    // Give each file its temporary name; then rename all, as the journal says.
    CommitJournal journal{{}, removals_};
    for (std::size_t i = 0; i < files_.size(); ++i) {
        if (Status status = files_[i].close(); !status) return status;
        const auto inside = std::filesystem::path(entries_[i].file).parent_path();
        journal.renames.push_back({(inside / files_[i].temporary().filename()).string(), entries_[i].file});
    }
    const auto failure = lobelia::commit(lock_->folder(), journal);
    if (failure && !failure->begun) return failure->error;
    for (StagedFile& file : files_) file.release();
    for (MadeFolder& made : made_) made.keep();
    return failure ? Status(failure->error) : Done{};
}

}  // namespace lobelia
