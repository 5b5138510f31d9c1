// A folder in memory, for readers that open files.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <span>
#include <string>

namespace lobelia {

/// A folder of this process in /dev/shm, or among the temporary files where there is none; removed at the end.
class MemoryFolder {
  public:
    MemoryFolder()
        : path_((std::filesystem::exists("/dev/shm") ? "/dev/shm" : std::filesystem::temp_directory_path()) /
                ("lobelia-fuzz-" + std::to_string(::getpid()))) {
        clear();
    }
    ~MemoryFolder() { std::filesystem::remove_all(path_); }
    MemoryFolder(const MemoryFolder&) = delete;
    MemoryFolder& operator=(const MemoryFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    void clear() const {
        std::filesystem::remove_all(path_);
        std::filesystem::create_directories(path_);
    }
    /// Writes a file, and makes the folders above it.
    void write(const std::filesystem::path& name, std::span<const std::byte> bytes) const {
        std::filesystem::create_directories((path_ / name).parent_path());
        std::ofstream(path_ / name, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    }

  private:
    std::filesystem::path path_;
};

}  // namespace lobelia
