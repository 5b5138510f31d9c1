// POSIX file descriptors for the readers and writers of files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <utility>

#include "lobelia/result.h"

namespace lobelia::io {

/// An owned descriptor. `close` returns whether closing worked: a full network disk may fail only then.
class Descriptor {
  public:
    explicit Descriptor(int value) : value_(value) {}
    Descriptor(Descriptor&& other) noexcept : value_(std::exchange(other.value_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(value_, other.value_);
        return *this;
    }
    ~Descriptor() { close(); }
    [[nodiscard]] bool is_open() const { return value_ >= 0; }
    [[nodiscard]] int get() const { return value_; }
    bool close();

  private:
    int value_;
};

/// Writes all bytes; false with errno if that fails.
[[nodiscard]] bool write_all(const Descriptor& descriptor, std::span<const std::byte> bytes);

/// Flushes a folder's entries to the disk: new files, renamings, removals.
[[nodiscard]] Status sync_folder(const std::filesystem::path& folder);

/// The error for a `path` that cannot be written, with the system's reason.
[[nodiscard]] Error write_failure(const std::filesystem::path& path, int code);

}  // namespace lobelia::io
