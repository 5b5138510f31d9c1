// Files that are written whole or not at all.
#include "io/write_file.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <vector>

#include "io/staged_file.h"

namespace lobelia {

namespace {

namespace fs = std::filesystem;

Result<StagedFile> stage(const fs::path& path, std::span<const std::byte> bytes) {
    auto staged = StagedFile::create(path);
    if (!staged) return staged;
    if (auto status = staged->write(bytes); !status) return status.error();
    if (auto status = staged->flush(); !status) return status.error();
    return staged;
}

Status write_directly(const fs::path& path, std::span<const std::byte> bytes) {
    io::Descriptor descriptor(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
    if (!descriptor.is_open() || !io::write_all(descriptor, bytes) || !descriptor.close())
        return io::write_failure(path, errno);
    return Done{};
}

}  // namespace

Status write_file_atomically(const fs::path& path, std::span<const std::byte> bytes) {
    const auto place = place_of_output(path);
    if (!place) return place.error();
    struct stat status {};
    // A descriptor's name leads to a pipe by no path: ask what opening it would give.
    const bool exists = *place == path ? ::lstat(path.c_str(), &status) == 0 : ::stat(path.c_str(), &status) == 0;
    if (exists && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode) && !S_ISLNK(status.st_mode))
        return write_directly(path, bytes);
    auto staged = stage(path, bytes);
    return staged ? staged->commit() : staged.error();
}

Status write_files_together(std::span<const FileContent> files) {
    std::vector<StagedFile> staged;
    for (const auto& file : files) {
        auto next = stage(file.path, std::as_bytes(std::span(file.text)));
        if (!next) return next.error();
        staged.push_back(*std::move(next));
    }
    for (auto& file : staged)
        if (auto status = file.commit(); !status) return status;
    return Done{};
}

Status write_file_atomically(const fs::path& path, std::string_view text) {
    return write_file_atomically(path, std::as_bytes(std::span(text)));
}

}  // namespace lobelia
