// One writer at a time in an output folder, by flock.
#include "io/folder_lock.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>

#include "io/counted.h"
#include "io/json.h"

namespace lobelia {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_lock_name = ".lobelia.lock";

fs::path lock_file(const fs::path& folder) { return folder / k_lock_name; }

/// Opens the file without following links or waiting.
Result<io::Descriptor> open_lock(const fs::path& path) {
    io::Descriptor file(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666));
    struct stat status {};
    if (!file.is_open() || ::fstat(file.get(), &status) != 0) return io::write_failure(path, errno);
    if (!S_ISREG(status.st_mode)) return Error{path.string() + ": not a regular file; remove it"};
    return file;
}

/// Returns whether the path still names the open file: the last owner removes it.
bool names(const fs::path& path, const io::Descriptor& file) {
    struct stat named {
    }, open{};
    return ::lstat(path.c_str(), &named) == 0 && ::fstat(file.get(), &open) == 0 && named.st_ino == open.st_ino &&
           named.st_dev == open.st_dev;
}

std::string age(std::int64_t seconds) {
    const auto count = [](std::int64_t n, const char* unit) { return counted(static_cast<std::size_t>(n), unit); };
    if (seconds < 120) return count(std::max<std::int64_t>(0, seconds), "second");
    if (seconds < 7200) return count(seconds / 60, "minute");
    return seconds < 48 * 3600 ? count(seconds / 3600, "hour") : count(seconds / (24 * 3600), "day");
}

void write_owner(const io::Descriptor& file) {
    std::array<char, 256> host{};
    if (::gethostname(host.data(), host.size() - 1) != 0) host.fill(0);
    const nlohmann::ordered_json owner = {
        {"process", ::getpid()}, {"host", host.data()}, {"seconds_since_1970", std::time(nullptr)}};
    const std::string text = owner.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace) + "\n";
    // It is for messages only: a full disk does not matter here.
    if (::ftruncate(file.get(), 0) == 0) (void)io::write_all(file, std::as_bytes(std::span(text)));
}

/// Describes the owner of a lock; anybody may have written the file.
std::string owner_in(const io::Descriptor& file, const std::string& name) {
    std::array<char, 1024> text{};
    const ssize_t size = ::pread(file.get(), text.data(), text.size(), 0);
    const auto described =
        read_json({text.data(), static_cast<std::size_t>(std::max<ssize_t>(0, size))}, name, [](const JsonPlace& top) {
            constexpr std::uint64_t k_latest = 253402300799;  // the end of the year 9999
            const auto since = static_cast<std::time_t>(top.at("seconds_since_1970").whole(0, k_latest));
            return fmt::format("process {} on {}, since {:%F %T} UTC ({} ago)", top.at("process").whole(0, 1u << 30),
                               top.at("host").file_name(), fmt::gmtime(since), age(std::time(nullptr) - since));
        });
    return described ? *described : "another process";
}

}  // namespace

Result<std::shared_ptr<const FolderLock>> FolderLock::take(const fs::path& folder) {
    const fs::path path = lock_file(folder);
    constexpr int k_attempts = 100;
    for (int i = 0; i < k_attempts; ++i) {
        auto made = MadeFolder::make(folder);
        if (!made) return made.error();
        auto file = open_lock(path);
        if (!file) return file.error();
        if (::flock(file->get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
            return Error{fmt::format("{}: in use by {}; wait for it, or give another folder", folder.string(),
                                     owner_in(*file, path.string()))};
        if (!names(path, *file)) continue;
        write_owner(*file);
        return std::shared_ptr<const FolderLock>(new FolderLock(folder, *std::move(made), *std::move(file)));
    }
    return Error{folder.string() + ": other processes take and leave its lock all the time; try again"};
}

FolderLock::FolderLock(fs::path folder, MadeFolder made, io::Descriptor file)
    : folder_(std::move(folder)), made_(std::move(made)), file_(std::move(file)) {}

FolderLock::~FolderLock() {
    // Remove the file while it is still locked: nobody else can own it.
    if (names(lock_file(folder_), file_)) ::unlink(lock_file(folder_).c_str());
}

}  // namespace lobelia
