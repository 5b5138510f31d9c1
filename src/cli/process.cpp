// Another program, run to its end.
#include "cli/process.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <thread>

#include "io/read_file.h"

extern char** environ;

namespace lobelia::cli {
namespace {

constexpr std::size_t k_most_output = std::size_t{1} << 24;

/// Starts the program with its output in two files.
Result<pid_t> start(const std::vector<std::string>& arguments, const std::filesystem::path& out,
                    const std::filesystem::path& err) {
    std::vector<char*> argv;
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    pid_t child = 0;
    const int code = posix_spawnp(&child, argv[0], &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (code != 0) return Error{fmt::format("{} cannot be run: {}", arguments[0], std::strerror(code))};
    return child;
}

std::string text_of(const std::filesystem::path& path) {
    const auto bytes = read_file(path, k_most_output);
    return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : std::string();
}

}  // namespace

Result<Finished> run_program(const std::vector<std::string>& arguments, std::chrono::seconds most,
                             const std::atomic<bool>& stop) {
    const auto folder = TemporaryFolder::make();
    if (!folder) return folder.error();
    const auto out = folder->path() / "out", err = folder->path() / "err";
    const auto child = start(arguments, out, err);
    if (!child) return child.error();

    // Look whether it has ended, at first often, then less.
    using Clock = std::chrono::steady_clock;
    const auto deadline = Clock::now() + most;
    auto pause = std::chrono::milliseconds(2);
    int status = 0;
    while (waitpid(*child, &status, WNOHANG) == 0) {
        if (const bool late = Clock::now() > deadline; late || stop) {
            kill(*child, SIGKILL);
            waitpid(*child, &status, 0);
            if (!late) return Error{"stopped", Error::Kind::stopped};
            return Error{fmt::format("{} was stopped: it took longer than {} s", arguments[0], most.count())};
        }
        std::this_thread::sleep_for(pause);
        pause = std::min(2 * pause, std::chrono::milliseconds(100));
    }
    if (WIFSIGNALED(status))
        return Error{fmt::format("{} ended by signal {}: {}", arguments[0], WTERMSIG(status), text_of(err))};
    return Finished{WEXITSTATUS(status), text_of(out), text_of(err)};
}

std::filesystem::path program_folder() {
    std::error_code code;
    return std::filesystem::read_symlink("/proc/self/exe", code).parent_path();
}

Result<TemporaryFolder> TemporaryFolder::make() {
    std::error_code code;
    std::string name = (std::filesystem::temp_directory_path(code) / "lobelia-XXXXXX").string();
    if (code || mkdtemp(name.data()) == nullptr)
        return Error{fmt::format("no temporary folder can be made: {}", code ? code.message() : std::strerror(errno))};
    return TemporaryFolder(name);
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code code;
    if (!path_.empty()) std::filesystem::remove_all(path_, code);
}

}  // namespace lobelia::cli
