// Files made by others, opened with care: only regular files, of a bounded size. Every reader of files uses this.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "io/descriptor.h"
#include "lobelia/result.h"

namespace lobelia {

struct InputOptions {
    enum class Links { followed, refused };
    /// Larger files are refused.
    std::uint64_t most_bytes = std::numeric_limits<std::uint64_t>::max();
    /// Symbolic links in the last component of the path.
    Links links = Links::followed;
};

/// A regular file opened for reading. Pipes, devices, sockets and folders are refused at once, without waiting for a
/// writer and without side effects on a device. Errors name the file and the cause.
class InputFile {
  public:
    [[nodiscard]] static Result<InputFile> open(const std::filesystem::path& path, const InputOptions& options = {});

    /// Opens a file below `folder`, which others may have filled: no component of `relative` may be a symbolic link or
    /// "..", so that nothing outside of the folder is opened, whatever changes meanwhile. The folder itself may be a
    /// link; empty: the current one.
    [[nodiscard]] static Result<InputFile> open_below(
        const std::filesystem::path& folder, const std::filesystem::path& relative,
        std::uint64_t most_bytes = std::numeric_limits<std::uint64_t>::max());

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] const io::Descriptor& descriptor() const { return descriptor_; }
    /// Size in bytes when the file was opened.
    [[nodiscard]] std::uint64_t size() const { return size_; }
    /// Fills `target` with the bytes from `position` on; an error if the file ends before.
    [[nodiscard]] Status read(std::uint64_t position, std::span<std::byte> target) const;

  private:
    /// The last component of `path`, in the folder of `at` (AT_FDCWD: the current one).
    [[nodiscard]] static Result<InputFile> open_at(int at, const std::filesystem::path& path, std::string name,
                                                   const InputOptions& options);
    InputFile(io::Descriptor descriptor, std::string name, std::uint64_t size)
        : descriptor_(std::move(descriptor)), name_(std::move(name)), size_(size) {}

    io::Descriptor descriptor_;
    std::string name_;
    std::uint64_t size_;
};

/// Reads all bytes of a regular file of at most `most_bytes`.
[[nodiscard]] Result<std::vector<std::byte>> read_file(const std::filesystem::path& path, std::size_t most_bytes);
/// Reads all bytes of an open file; an error if its size has changed since.
[[nodiscard]] Result<std::vector<std::byte>> read_file(const InputFile& file);

/// Reads a regular file of at most `most_mebibytes` as text; any bytes may be in it.
[[nodiscard]] Result<std::string> read_text(const std::filesystem::path& path, std::size_t most_mebibytes = 64);
[[nodiscard]] Result<std::string> read_text(const InputFile& file);

}  // namespace lobelia
