// Another program, run to its end.
#include "cli/process.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <thread>

#include "io/read_file.h"

namespace lobelia::cli {
namespace {

constexpr std::size_t k_most_output = std::size_t{1} << 24;

/// Opens a file as one of the child's standard streams. Only calls that are safe between fork and exec.
bool open_as(int stream, const char* path, int flags) {
    const int opened = ::open(path, flags, 0600);
    return opened >= 0 && ::dup2(opened, stream) >= 0;
}

/// Becomes the program, or returns with errno.
void become(char* const* argv, const char* out, const char* err, pid_t parent) {
    // Die with the parent, which may have died by now.
#ifdef __linux__
    if (::prctl(PR_SET_PDEATHSIG, SIGKILL) != 0) return;
#endif
    if (::getppid() != parent) ::_exit(1);
    // A group of its own is killed as a whole, and gets no signals from the terminal.
    if (::setpgid(0, 0) != 0) return;
    ::signal(SIGPIPE, SIG_DFL);
    constexpr int k_write = O_WRONLY | O_CREAT | O_TRUNC;
    if (open_as(STDIN_FILENO, "/dev/null", O_RDONLY) && open_as(STDOUT_FILENO, out, k_write) &&
        open_as(STDERR_FILENO, err, k_write))
        ::execvp(argv[0], argv);
}

/// Starts the program with its output in two files.
Result<pid_t> start(const std::vector<std::string>& arguments, const std::filesystem::path& out,
                    const std::filesystem::path& err) {
    std::vector<char*> argv;
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    const auto failure = [&](int code) {
        return Error{fmt::format("{} cannot be run: {}", arguments[0], std::strerror(code))};
    };

    // The child reports through a pipe, which exec closes, why it could not become the program.
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) return failure(errno);
    io::Descriptor report(ends[0]), reporting(ends[1]);
    const pid_t parent = ::getpid(), child = ::fork();
    if (child < 0) return failure(errno);
    if (child == 0) {
        become(argv.data(), out.c_str(), err.c_str(), parent);
        const int code = errno;
        [[maybe_unused]] const ssize_t written = ::write(reporting.get(), &code, sizeof code);
        ::_exit(1);
    }
    reporting.close();
    int code = 0;
    ssize_t count = 0;
    while ((count = ::read(report.get(), &code, sizeof code)) < 0 && errno == EINTR) {
    }
    if (count == 0) return child;
    ::waitpid(child, nullptr, 0);
    return failure(code);
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
            kill(-*child, SIGKILL);
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

namespace {

constexpr std::string_view k_folder_prefix = "lobelia-run-";

/// Opens a folder, not a link to one, and tries to lock it; not open where that fails.
io::Descriptor open_locked(const std::filesystem::path& folder) {
    io::Descriptor lock(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
    if (lock.is_open() && ::flock(lock.get(), LOCK_EX | LOCK_NB) != 0) lock.close();
    return lock;
}

/// Removes this user's folders that nobody holds a lock on: their process is gone.
void remove_abandoned(const std::filesystem::path& where) {
    std::error_code code;
    for (std::filesystem::directory_iterator entry(where, code), end; !code && entry != end; entry.increment(code)) {
        if (!entry->path().filename().string().starts_with(k_folder_prefix)) continue;
        const io::Descriptor lock = open_locked(entry->path());
        struct stat status {};
        if (!lock.is_open() || ::fstat(lock.get(), &status) != 0 || status.st_uid != ::geteuid()) continue;
        std::error_code ignored;
        std::filesystem::remove_all(entry->path(), ignored);
    }
}

}  // namespace

Result<TemporaryFolder> TemporaryFolder::make() {
    std::error_code code;
    const std::filesystem::path where = std::filesystem::temp_directory_path(code);
    if (code) return Error{fmt::format("no temporary folder can be made: {}", code.message())};
    remove_abandoned(where);
    // Another process may take the new folder for an abandoned one before it is locked: then make another.
    constexpr int k_attempts = 100;
    for (int i = 0; i < k_attempts; ++i) {
        std::string name = (where / (std::string(k_folder_prefix) + "XXXXXX")).string();
        if (mkdtemp(name.data()) == nullptr) break;
        io::Descriptor lock = open_locked(name);
        struct stat status {};
        if (lock.is_open() && ::fstat(lock.get(), &status) == 0 && status.st_nlink > 0)
            return TemporaryFolder(name, std::move(lock));
    }
    return Error{fmt::format("no temporary folder can be made in {}: {}", where.string(), std::strerror(errno))};
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code code;
    if (!path_.empty()) std::filesystem::remove_all(path_, code);
}

}  // namespace lobelia::cli
