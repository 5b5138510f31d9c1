// POSIX file descriptors for the readers and writers of files.
#include "io/descriptor.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace lobelia::io {

bool Descriptor::close() {
    const int value = std::exchange(value_, -1);
    return value < 0 || ::close(value) == 0;
}

bool write_all(const Descriptor& descriptor, std::span<const std::byte> bytes) {
    // Linux writes at most 2 GiB at once.
    constexpr std::size_t k_most = std::size_t{1} << 30;
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor.get(), bytes.data(), std::min(bytes.size(), k_most));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return false;
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return true;
}

Status sync_folder(const std::filesystem::path& folder) {
    const Descriptor descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (!descriptor.is_open()) return write_failure(folder, errno);
    // Some file systems cannot do this for folders, and say so.
    if (::fsync(descriptor.get()) != 0 && errno != EINVAL) return write_failure(folder, errno);
    return Done{};
}

Error write_failure(const std::filesystem::path& path, int code) {
    return Error{fmt::format("{}: cannot be written: {}", path.string(), std::generic_category().message(code))};
}

}  // namespace lobelia::io
