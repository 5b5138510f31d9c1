// Another program, run to its end.
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "io/descriptor.h"
#include "lobelia/result.h"

namespace lobelia::cli {

struct Finished {
    int code = 0;
    std::string out;  ///< what it printed
    std::string err;  ///< what it printed on stderr
};

/// Runs arguments[0], found on PATH, with the rest as they are: no shell sees them. Its input is empty. An error where
/// it cannot be started or dies of a signal, and where it lasts longer than `most` or `stop` is set: then it is killed,
/// with the programs that it started. It is killed too when this process dies, however that happens (Linux); keys on
/// the terminal reach this process alone. Call it from the thread that ends last.
[[nodiscard]] Result<Finished> run_program(const std::vector<std::string>& arguments, std::chrono::seconds most,
                                           const std::atomic<bool>& stop);

/// The folder of this program's own file.
[[nodiscard]] std::filesystem::path program_folder();

/// A folder for files in passing, removed with all that is in it. Folders whose process was killed before it could
/// remove them are removed by the next `make`: a folder in use is locked.
class TemporaryFolder {
  public:
    [[nodiscard]] static Result<TemporaryFolder> make();
    TemporaryFolder(TemporaryFolder&& other) noexcept
        : path_(std::exchange(other.path_, {})), lock_(std::move(other.lock_)) {}
    TemporaryFolder& operator=(TemporaryFolder&&) = delete;
    ~TemporaryFolder();
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    TemporaryFolder(std::filesystem::path path, io::Descriptor lock) : path_(std::move(path)), lock_(std::move(lock)) {}
    std::filesystem::path path_;
    io::Descriptor lock_;  ///< of the folder itself
};

}  // namespace lobelia::cli
