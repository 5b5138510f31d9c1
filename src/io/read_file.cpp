// Files made by others, opened with care, by POSIX calls.
#include "io/read_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

namespace lobelia {

namespace {

Error read_failure(std::string_view name, int code) {
    return Error{fmt::format("{}: cannot be read: {}", name, std::generic_category().message(code))};
}

Status check_kind(std::string_view name, const struct stat& status) {
    if (S_ISREG(status.st_mode)) return Done{};
    if (S_ISDIR(status.st_mode)) return Error{fmt::format("{}: a folder, not a regular file", name)};
    if (S_ISLNK(status.st_mode)) return Error{fmt::format("{}: a symbolic link, not a regular file", name)};
    const char* const kind = S_ISFIFO(status.st_mode) ? "pipe" : S_ISSOCK(status.st_mode) ? "socket" : "device";
    return Error{fmt::format("{}: a {}, not a regular file; write its content to a file first", name, kind)};
}

template <class Bytes>
Result<Bytes> read_whole(const InputFile& file) {
    Bytes bytes(static_cast<std::size_t>(file.size()), {});
    if (const Status status = file.read(0, std::as_writable_bytes(std::span(bytes))); !status) return status.error();
    std::array<std::byte, 1> more{};
    if (file.read(file.size(), more)) return Error{fmt::format("{}: changed while it was read", file.name())};
    return bytes;
}

template <class Bytes>
Result<Bytes> read_whole(const std::filesystem::path& path, std::uint64_t most_bytes) {
    const auto file = InputFile::open(path, {.most_bytes = most_bytes});
    if (!file) return file.error();
    return read_whole<Bytes>(*file);
}

}  // namespace

Result<InputFile> InputFile::open(const std::filesystem::path& path, const InputOptions& options) {
    return open_at(AT_FDCWD, path, path.string(), options);
}

Result<InputFile> InputFile::open_below(const std::filesystem::path& folder, const std::filesystem::path& relative,
                                        std::uint64_t most_bytes) {
    // Open one folder within the other: a path as a whole would follow links.
    const std::string name = (folder / relative).string();
    io::Descriptor at(::open(folder.empty() ? "." : folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
    if (!at.is_open()) return read_failure(name, errno);
    if (relative.empty() || relative.is_absolute()) return Error{name + ": not a file below the folder"};
    for (const auto& component : relative.parent_path()) {
        if (component == "..") return Error{name + ": it leads out of the folder"};
        io::Descriptor next(::openat(at.get(), component.c_str(), O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
        if (!next.is_open() && (errno == ENOTDIR || errno == ELOOP))
            return Error{
                fmt::format("{}: \"{}\" is a symbolic link or a file, not a folder", name, component.string())};
        if (!next.is_open()) return read_failure(name, errno);
        at = std::move(next);
    }
    return open_at(at.get(), relative.filename(), name, {most_bytes, InputOptions::Links::refused});
}

Result<InputFile> InputFile::open_at(int at, const std::filesystem::path& path, std::string name,
                                     const InputOptions& options) {
    // Refuse what is not a regular file before opening it: a pipe would wait, a device might act.
    const bool follow = options.links == InputOptions::Links::followed;
    struct stat status {};
    if (::fstatat(at, path.c_str(), &status, follow ? 0 : AT_SYMLINK_NOFOLLOW) != 0) return read_failure(name, errno);
    if (const Status kind = check_kind(name, status); !kind) return kind.error();

    // Open it, and check what was really opened: the path may name another file by now.
    const int flags = O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY | (follow ? 0 : O_NOFOLLOW);
    io::Descriptor descriptor(::openat(at, path.c_str(), flags));
    if (!descriptor.is_open() || ::fstat(descriptor.get(), &status) != 0) return read_failure(name, errno);
    if (const Status kind = check_kind(name, status); !kind) return kind.error();
    const auto size = static_cast<std::uint64_t>(status.st_size);
    if (size > options.most_bytes)
        return Error{fmt::format("{}: {} bytes; at most {} are read", name, size, options.most_bytes)};
    return InputFile(std::move(descriptor), std::move(name), size);
}

Status InputFile::read(std::uint64_t position, std::span<std::byte> target) const {
    // Linux reads at most 2 GiB at once.
    constexpr std::size_t k_most = std::size_t{1} << 30;
    while (!target.empty()) {
        const ssize_t count =
            ::pread(descriptor_.get(), target.data(), std::min(target.size(), k_most), static_cast<off_t>(position));
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return read_failure(name_, errno);
        if (count == 0) return Error{fmt::format("{}: the file ends too early", name_)};
        position += static_cast<std::uint64_t>(count);
        target = target.subspan(static_cast<std::size_t>(count));
    }
    return Done{};
}

Result<std::vector<std::byte>> read_file(const std::filesystem::path& path, std::size_t most_bytes) {
    return read_whole<std::vector<std::byte>>(path, most_bytes);
}

Result<std::vector<std::byte>> read_file(const InputFile& file) { return read_whole<std::vector<std::byte>>(file); }

Result<std::string> read_text(const InputFile& file) { return read_whole<std::string>(file); }

Result<std::string> read_text(const std::filesystem::path& path, std::size_t most_mebibytes) {
    return read_whole<std::string>(path, std::uint64_t{most_mebibytes} << 20);
}

}  // namespace lobelia
