// Several files of one folder, all complete before the first takes its place.
#include "bake/write/files_together.h"

namespace lobelia {

Result<FilesTogether> FilesTogether::in(const std::filesystem::path& folder, StopFlag stop) {
    auto made = MadeFolder::make(folder);
    if (!made) return made.error();
    return FilesTogether(folder, *std::move(made), stop);
}

Status FilesTogether::add_text(const std::string& name, std::string_view text) {
    return add(name, [&](StagedFile& file) { return file.write(std::as_bytes(std::span(text))); });
}

Status FilesTogether::commit() {
    for (auto& file : files_)
        if (Status status = file.commit(); !status) return status;
    made_.keep();
    return Done{};
}

}  // namespace lobelia
