// Files that are written whole or not at all, by POSIX calls: streams of C++ cannot tell why a write failed.
#include "io/write_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace lobelia {

namespace {

namespace fs = std::filesystem;

/// A descriptor that closes itself; `close` tells whether that worked, as a full network disk may say only then.
class Descriptor {
  public:
    explicit Descriptor(int value) : value_(value) {}
    Descriptor(Descriptor&& other) noexcept : value_(std::exchange(other.value_, -1)) {}
    Descriptor& operator=(Descriptor&&) = delete;
    ~Descriptor() { close(); }
    [[nodiscard]] bool is_open() const { return value_ >= 0; }
    [[nodiscard]] int get() const { return value_; }
    bool close() {
        const int value = std::exchange(value_, -1);
        return value < 0 || ::close(value) == 0;
    }

  private:
    int value_;
};

Error failure(const fs::path& path, int code) {
    return Error{fmt::format("{}: cannot be written: {}", path.string(), std::generic_category().message(code))};
}

/// Writes all bytes; false with errno where that fails.
bool write_all(int descriptor, std::span<const std::byte> bytes) {
    // Linux writes at most 2 GiB at once.
    constexpr std::size_t k_most = std::size_t{1} << 30;
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), std::min(bytes.size(), k_most));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return false;
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return true;
}

/// A new file of the folder of `path` under a name that no other process or thread has, made by `create(name)`, which
/// tells whether it could.
template <class Create>
std::optional<fs::path> create_named_beside(const fs::path& path, const Create& create) {
    constexpr int k_attempts = 1000;
    for (int i = 0; i < k_attempts; ++i) {
        fs::path candidate = path.parent_path() / fmt::format(".lobelia-{}-{}.tmp", ::getpid(), i);
        if (create(candidate)) return candidate;
        if (errno != EEXIST) return std::nullopt;
    }
    return std::nullopt;
}

/// A file whose new content is complete beside it, until `commit` puts it in place. Where the system can, it has no
/// name before that, so that nothing is left of it if the process is ended; else the destructor removes it.
class StagedFile {
  public:
    /// `temporary` is the file's name until then, empty while it has none.
    StagedFile(fs::path target, Descriptor descriptor, fs::path temporary)
        : target_(std::move(target)), descriptor_(std::move(descriptor)), temporary_(std::move(temporary)) {}
    StagedFile(StagedFile&& other) noexcept
        : target_(std::move(other.target_)),
          descriptor_(std::move(other.descriptor_)),
          temporary_(std::exchange(other.temporary_, {})) {}
    StagedFile& operator=(StagedFile&&) = delete;
    ~StagedFile() {
        if (!temporary_.empty()) ::unlink(temporary_.c_str());
    }

    [[nodiscard]] Status commit() {
        if (temporary_.empty()) {
            const std::string self = fmt::format("/proc/self/fd/{}", descriptor_.get());
            const auto named = create_named_beside(target_, [&](const fs::path& name) {
                return ::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
            });
            if (!named) return failure(target_, errno);
            temporary_ = *named;
        }
        if (!descriptor_.close() || ::rename(temporary_.c_str(), target_.c_str()) != 0) return failure(target_, errno);
        temporary_.clear();
        return Done{};
    }

    [[nodiscard]] int descriptor() const { return descriptor_.get(); }

  private:
    fs::path target_;
    Descriptor descriptor_;
    fs::path temporary_;
};

/// An empty staged file, unnamed if the system can do that there.
Result<StagedFile> create_staged(const fs::path& path) {
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    Descriptor unnamed(::open(folder.c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666));
    if (unnamed.is_open() && ::access("/proc/self/fd", X_OK) == 0) return StagedFile(path, std::move(unnamed), {});
    int opened = -1;
    const auto name = create_named_beside(path, [&](const fs::path& candidate) {
        opened = ::open(candidate.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        return opened >= 0;
    });
    if (!name) return failure(path, errno);
    return StagedFile(path, Descriptor(opened), *name);
}

Result<StagedFile> stage(const fs::path& path, std::span<const std::byte> bytes) {
    auto staged = create_staged(path);
    if (!staged) return staged;
    // Keep the permissions of the file that is replaced.
    struct stat old {};
    const bool replaces = ::stat(path.c_str(), &old) == 0;
    const bool done = (!replaces || ::fchmod(staged->descriptor(), old.st_mode & 0777) == 0) &&
                      write_all(staged->descriptor(), bytes) && ::fsync(staged->descriptor()) == 0;
    if (!done) return failure(path, errno);
    return staged;
}

Status write_directly(const fs::path& path, std::span<const std::byte> bytes) {
    Descriptor descriptor(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
    if (!descriptor.is_open() || !write_all(descriptor.get(), bytes) || !descriptor.close())
        return failure(path, errno);
    return Done{};
}

/// The end of a chain of links, which need not exist; an error where links lead in a circle.
Result<fs::path> followed(fs::path path) {
    constexpr int k_most_links = 40;
    for (int i = 0; i < k_most_links; ++i) {
        std::error_code code;
        if (!fs::is_symlink(fs::symlink_status(path, code))) return path;
        const fs::path target = fs::read_symlink(path, code);
        if (code) return failure(path, code.value());
        path = path.parent_path() / target;
    }
    return failure(path, ELOOP);
}

}  // namespace

Status write_file_atomically(const fs::path& path, std::span<const std::byte> bytes) {
    if (path.empty()) return Error{"a file name is missing"};
    struct stat status {};
    if (::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode)) {
        if (S_ISDIR(status.st_mode)) return failure(path, EISDIR);
        return write_directly(path, bytes);
    }
    const Result<fs::path> target = followed(path);
    if (!target) return target.error();
    auto staged = stage(*target, bytes);
    return staged ? staged->commit() : staged.error();
}

Status write_files_together(std::span<const FileContent> files) {
    std::vector<StagedFile> staged;
    for (const auto& file : files) {
        if (fs::is_directory(file.path)) return failure(file.path, EISDIR);
        const Result<fs::path> target = followed(file.path);
        if (!target) return target.error();
        auto next = stage(*target, std::as_bytes(std::span(file.text)));
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
