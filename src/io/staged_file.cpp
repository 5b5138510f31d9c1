// Files that are written whole or not at all, by POSIX calls: C++ streams do not report why a write failed.
#include "io/staged_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <optional>
#include <regex>
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

/// Tests for links of the system, which lead to a process's own descriptors. Those in /dev/shm are anybody's.
bool is_of_system(const fs::path& path) {
    const std::string normal = path.lexically_normal().string();
    return (normal.starts_with("/dev/") && !normal.starts_with("/dev/shm/")) || normal.starts_with("/proc/");
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
    int opened = ::open(folder.c_str(), O_RDWR | O_TMPFILE | O_CLOEXEC, 0666);
    std::optional<fs::path> temporary = fs::path();
    if (opened < 0 || ::access("/proc/self/fd", X_OK) != 0) {
        if (opened >= 0) ::close(opened);
        temporary = create_named_beside(*target, [&](const fs::path& candidate) {
            opened = ::open(candidate.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            return opened >= 0;
        });
        if (!temporary) return io::write_failure(path, errno);
    }
    StagedFile staged(*target, io::Descriptor(opened), *temporary, stop);
    (void)::flock(opened, LOCK_EX | LOCK_NB);
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

Result<FileSum> StagedFile::sum() const { return sum_of(descriptor_, target_.string()); }

Status StagedFile::name() {
    if (!temporary_.empty()) return Done{};
    const std::string self = fmt::format("/proc/self/fd/{}", descriptor_.get());
    const auto named = create_named_beside(target_, [&](const fs::path& name) {
        return ::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
    });
    if (!named) return io::write_failure(target_, errno);
    temporary_ = *named;
    return Done{};
}

Status StagedFile::close() {
    if (Status status = name(); !status) return status;
    if (!descriptor_.close()) return io::write_failure(target_, errno);
    return Done{};
}

Status StagedFile::commit() {
    // Close it last: it is locked while it has a temporary name. After `flush`, nothing is left that closing can lose.
    if (Status status = name(); !status) return status;
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) return io::write_failure(target_, errno);
    temporary_.clear();
    return descriptor_.close() ? Status(Done{}) : io::write_failure(target_, errno);
}

bool is_temporary_name(std::string_view name) {
    // What create_named_beside makes: the process, the hash of the final name, the attempt.
    static const std::regex pattern(R"(\.lobelia-[0-9]+-[0-9a-f]+-[0-9]+\.tmp)");
    return std::regex_match(name.begin(), name.end(), pattern);
}

void remove_abandoned_files(const fs::path& folder) {
    std::error_code code;
    for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
        if (!is_temporary_name(entry->path().filename().string())) continue;
        const io::Descriptor file(::open(entry->path().c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
        struct stat status {};
        if (!file.is_open() || ::fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode)) continue;
        if (::flock(file.get(), LOCK_EX | LOCK_NB) == 0) ::unlink(entry->path().c_str());
    }
}

}  // namespace lobelia
