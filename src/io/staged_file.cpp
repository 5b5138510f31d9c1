// Files that are written whole or not at all, by POSIX calls: C++ streams do not report why a write failed.
#include "io/staged_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <optional>
#include <system_error>

namespace lobelia {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view k_temporary_prefix = ".lobelia-", k_temporary_extension = ".tmp";

/// Creates a file beside `path` under a name that no other process or thread uses, by `create(name)`, which returns
/// false if it cannot. Files staged at the same time differ in the hash of their names.
template <class Create>
std::optional<fs::path> create_named_beside(const fs::path& path, const Create& create) {
    constexpr int k_attempts = 1000;
    const std::size_t name = fs::hash_value(path.filename());
    for (int i = 0; i < k_attempts; ++i) {
        fs::path candidate = path.parent_path() / fmt::format("{}{}-{:x}-{}{}", k_temporary_prefix, ::getpid(), name, i,
                                                              k_temporary_extension);
        if (create(candidate)) return candidate;
        if (errno != EEXIST) return std::nullopt;
    }
    return std::nullopt;
}

/// Tests for links of the system, which lead to a process's own descriptors.
bool is_of_system(const fs::path& path) {
    const std::string normal = path.lexically_normal().string();
    return normal.starts_with("/dev/") || normal.starts_with("/proc/");
}

}  // namespace

Result<fs::path> place_of_output(fs::path path) {
    constexpr int k_most_links = 40;
    for (int i = 0; i < k_most_links; ++i) {
        std::error_code code;
        if (!is_of_system(path) || !fs::is_symlink(fs::symlink_status(path, code))) return path;
        const fs::path target = fs::read_symlink(path, code);
        if (code) return io::write_failure(path, code.value());
        path = path.parent_path() / target;
    }
    return io::write_failure(path, ELOOP);
}

StagedFile::StagedFile(fs::path target, io::Descriptor descriptor, fs::path temporary, StopFlag stop)
    : target_(std::move(target)), descriptor_(std::move(descriptor)), temporary_(std::move(temporary)), stop_(stop) {}

StagedFile::StagedFile(StagedFile&& other) noexcept
    : target_(std::move(other.target_)),
      descriptor_(std::move(other.descriptor_)),
      temporary_(std::exchange(other.temporary_, {})),
      stop_(other.stop_) {}

StagedFile::~StagedFile() {
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

Result<StagedFile> StagedFile::create(const fs::path& path, StopFlag stop) {
    // Find the file that it will replace.
    if (path.empty()) return Error{"a file name is missing"};
    const Result<fs::path> target = place_of_output(path);
    if (!target) return target.error();
    struct stat old {};
    const bool replaces = ::lstat(target->c_str(), &old) == 0 && !S_ISLNK(old.st_mode);
    if (replaces && S_ISDIR(old.st_mode)) return io::write_failure(path, EISDIR);
    if (replaces && !S_ISREG(old.st_mode)) return Error{path.string() + ": cannot be replaced: not a regular file"};

    // Open a file without a name if the system can do that there, else one with a name of its own.
    const fs::path folder = target->has_parent_path() ? target->parent_path() : fs::path(".");
    int opened = ::open(folder.c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666);
    std::optional<fs::path> temporary = fs::path();
    if (opened < 0 || ::access("/proc/self/fd", X_OK) != 0) {
        if (opened >= 0) ::close(opened);
        temporary = create_named_beside(*target, [&](const fs::path& candidate) {
            opened = ::open(candidate.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            return opened >= 0;
        });
        if (!temporary) return io::write_failure(path, errno);
    }
    StagedFile staged(*target, io::Descriptor(opened), *temporary, stop);
    if (replaces && ::fchmod(opened, old.st_mode & 0777) != 0) return io::write_failure(path, errno);
    return staged;
}

Status StagedFile::write(std::span<const std::byte> bytes) {
    if (stop_.is_set()) return stopped_error();
    if (!io::write_all(descriptor_, bytes)) return io::write_failure(target_, errno);
    return Done{};
}

Status StagedFile::seek(std::uint64_t position) {
    if (::lseek(descriptor_.get(), static_cast<off_t>(position), SEEK_SET) < 0)
        return io::write_failure(target_, errno);
    return Done{};
}

Status StagedFile::flush() {
    if (stop_.is_set()) return stopped_error();
    if (::fsync(descriptor_.get()) != 0) return io::write_failure(target_, errno);
    return Done{};
}

Status StagedFile::close() {
    if (temporary_.empty()) {
        const std::string self = fmt::format("/proc/self/fd/{}", descriptor_.get());
        const auto named = create_named_beside(target_, [&](const fs::path& name) {
            return ::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
        });
        if (!named) return io::write_failure(target_, errno);
        temporary_ = *named;
    }
    if (!descriptor_.close()) return io::write_failure(target_, errno);
    return Done{};
}

Status StagedFile::commit() {
    if (Status status = close(); !status) return status;
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) return io::write_failure(target_, errno);
    temporary_.clear();
    return Done{};
}

}  // namespace lobelia
