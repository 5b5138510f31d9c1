// Another program, run to its end.
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "lobelia/result.h"

namespace lobelia::cli {

struct Finished {
    int code = 0;
    std::string out;  ///< what it printed
    std::string err;  ///< what it printed on stderr
};

/// Runs arguments[0], found on PATH, with the rest as they are: no shell sees them. Its input is empty. An error where
/// it cannot be started or dies of a signal, and where it lasts longer than `most` or `stop` is set: then it is killed.
[[nodiscard]] Result<Finished> run_program(const std::vector<std::string>& arguments, std::chrono::seconds most,
                                           const std::atomic<bool>& stop);

/// The folder of this program's own file.
[[nodiscard]] std::filesystem::path program_folder();

/// A folder for files in passing, removed with all that is in it.
class TemporaryFolder {
  public:
    [[nodiscard]] static Result<TemporaryFolder> make();
    TemporaryFolder(TemporaryFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
    TemporaryFolder& operator=(TemporaryFolder&&) = delete;
    ~TemporaryFolder();
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    explicit TemporaryFolder(std::filesystem::path path) : path_(std::move(path)) {}
    std::filesystem::path path_;
};

}  // namespace lobelia::cli
