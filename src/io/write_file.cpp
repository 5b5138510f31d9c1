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

struct Temporary {
    fs::path path;
    Descriptor descriptor;
};

/// A new file beside `path`, which no other process or thread has.
std::optional<Temporary> create_beside(const fs::path& path) {
    constexpr int k_attempts = 1000;
    for (int i = 0; i < k_attempts; ++i) {
        fs::path candidate = path.parent_path() / fmt::format(".lobelia-{}-{}.tmp", ::getpid(), i);
        Descriptor descriptor(::open(candidate.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
        if (descriptor.is_open()) return Temporary{std::move(candidate), std::move(descriptor)};
        if (errno != EEXIST) return std::nullopt;
    }
    return std::nullopt;
}

/// A file whose new content lies complete beside it, until `commit` renames it or the destructor removes it.
class StagedFile {
  public:
    StagedFile(fs::path target, fs::path temporary) : target_(std::move(target)), temporary_(std::move(temporary)) {}
    StagedFile(StagedFile&& other) noexcept
        : target_(std::move(other.target_)), temporary_(std::exchange(other.temporary_, {})) {}
    StagedFile& operator=(StagedFile&&) = delete;
    ~StagedFile() {
        if (!temporary_.empty()) ::unlink(temporary_.c_str());
    }
    [[nodiscard]] Status commit() {
        if (::rename(temporary_.c_str(), target_.c_str()) != 0) return failure(target_, errno);
        temporary_.clear();
        return Done{};
    }

  private:
    fs::path target_, temporary_;
};

Result<StagedFile> stage(const fs::path& path, std::span<const std::byte> bytes) {
    std::optional<Temporary> temporary = create_beside(path);
    if (!temporary) return failure(path, errno);
    StagedFile staged(path, temporary->path);
    // Keep the permissions of the file that is replaced.
    struct stat old {};
    const bool replaces = ::stat(path.c_str(), &old) == 0;
    const bool done = (!replaces || ::fchmod(temporary->descriptor.get(), old.st_mode & 0777) == 0) &&
                      write_all(temporary->descriptor.get(), bytes) && ::fsync(temporary->descriptor.get()) == 0 &&
                      temporary->descriptor.close();
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
