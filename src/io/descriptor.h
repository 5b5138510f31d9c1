// POSIX file descriptors for the writers of files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <utility>

#include "lobelia/result.h"

namespace lobelia::io {

/// An owned descriptor; `close` tells whether that worked, as a full network disk may say only then.
class Descriptor {
  public:
    explicit Descriptor(int value) : value_(value) {}
    Descriptor(Descriptor&& other) noexcept : value_(std::exchange(other.value_, -1)) {}
    Descriptor& operator=(Descriptor&&) = delete;
    ~Descriptor() { close(); }
    [[nodiscard]] bool is_open() const { return value_ >= 0; }
    [[nodiscard]] int get() const { return value_; }
    bool close();

  private:
    int value_;
};

/// Writes all bytes; false with errno where that fails.
[[nodiscard]] bool write_all(const Descriptor& descriptor, std::span<const std::byte> bytes);

/// That `path` could not be written, and the system's reason.
[[nodiscard]] Error write_failure(const std::filesystem::path& path, int code);

}  // namespace lobelia::io
