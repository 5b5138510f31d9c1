// Several files of one folder, all complete before the first takes its place.
#include "bake/write/files_together.h"

#include <fmt/format.h>

#include <system_error>

namespace lobelia {

Result<FilesTogether> FilesTogether::in(const std::filesystem::path& folder) {
    std::error_code code;
    const bool made = std::filesystem::create_directories(folder, code);
    if (!code && !std::filesystem::is_directory(folder, code) && !code)
        code = std::make_error_code(std::errc::not_a_directory);
    if (code) return Error{fmt::format("{}: cannot be made a folder: {}", folder.string(), code.message())};
    return FilesTogether(folder, made ? folder : std::filesystem::path());
}

FilesTogether::FilesTogether(FilesTogether&& other) noexcept
    : folder_(std::move(other.folder_)), made_(std::exchange(other.made_, {})), files_(std::move(other.files_)) {}

FilesTogether::~FilesTogether() {
    files_.clear();
    std::error_code code;
    if (!made_.empty()) std::filesystem::remove(made_, code);
}

Status FilesTogether::add_text(const std::string& name, std::string_view text) {
    return add(name, [&](StagedFile& file) { return file.write(std::as_bytes(std::span(text))); });
}

Status FilesTogether::commit() {
    for (auto& file : files_)
        if (Status status = file.commit(); !status) return status;
    made_.clear();
    return Done{};
}

}  // namespace lobelia
