// Files that take their places together, by a journal of renamings.
#include "io/commit_journal.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <nlohmann/json.hpp>
#include <set>

#include "io/descriptor.h"
#include "io/json.h"
#include "io/read_file.h"
#include "io/staged_file.h"
#include "io/write_file.h"

namespace lobelia {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr const char* k_journal_name = ".lobelia.commit";
constexpr std::uint64_t k_version = 1;
constexpr std::size_t k_most_files = std::size_t{1} << 20;
constexpr std::uint64_t k_most_bytes = std::uint64_t{256} << 20;

fs::path journal_file(const fs::path& folder) { return folder / k_journal_name; }

std::string to_json_text(const CommitJournal& journal) {
    ordered_json renames = ordered_json::array();
    for (const auto& [from, to] : journal.renames) renames.push_back({{"from", from}, {"to", to}});
    const ordered_json document = {
        {"lobelia_commit", k_version}, {"renames", std::move(renames)}, {"removals", journal.removals}};
    return document.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

/// A name inside the folder, or inside a folder in it: nothing else is touched, whoever wrote the journal.
std::string name_inside(const JsonPlace& place) {
    const std::string name = place.text();
    const auto plain = [](std::string_view part) {
        return !part.empty() && part != "." && part != ".." && part.find('/') == std::string_view::npos &&
               part.find('\0') == std::string_view::npos;
    };
    const std::size_t slash = std::min(name.find('/'), name.size());
    const std::string_view first = std::string_view(name).substr(0, slash);
    if (!plain(first) || (slash < name.size() && !plain(std::string_view(name).substr(slash + 1))))
        place.refuse("not a file of this folder");
    return name;
}

Result<CommitJournal> read_journal(const fs::path& path) {
    const auto file = InputFile::open(path, {.most_bytes = k_most_bytes, .links = InputOptions::Links::refused});
    if (!file) return file.error();
    const auto text = read_text(*file);
    if (!text) return text.error();
    auto journal = read_json(*text, path.string(), [](const JsonPlace& top) {
        CommitJournal read;
        if (top.at("lobelia_commit").whole(0, ~std::uint32_t{0}) != k_version)
            top.at("lobelia_commit").refuse(fmt::format("this program reads version {}", k_version));
        for (const JsonPlace& entry : top.at("renames").list(k_most_files)) {
            read.renames.push_back({name_inside(entry.at("from")), name_inside(entry.at("to"))});
            if (!is_temporary_name(fs::path(read.renames.back().from).filename().string()))
                entry.at("from").refuse("not a temporary name");
        }
        for (const JsonPlace& entry : top.at("removals").list(k_most_files))
            read.removals.push_back(name_inside(entry));
        return read;
    });
    if (!journal) return Error{journal.error().message + "; if Lobelia did not write this file, remove it"};
    return journal;
}

bool is_there(const fs::path& path) {
    struct stat status {};
    return ::lstat(path.c_str(), &status) == 0;
}

/// Flushes the folders that hold the journal's files. An error for folders inside that are symbolic links: they would
/// lead elsewhere.
Status sync_folders(const fs::path& folder, const CommitJournal& journal) {
    std::set<fs::path> inside = {fs::path()};
    for (const auto& rename : journal.renames) inside.insert(fs::path(rename.to).parent_path());
    for (const auto& removed : journal.removals) inside.insert(fs::path(removed).parent_path());
    for (const fs::path& name : inside) {
        std::error_code code;
        const fs::path each = name.empty() ? folder : folder / name;
        if (!name.empty() && fs::is_symlink(each, code))
            return Error{each.string() + ": a symbolic link; make it a folder"};
        if (!is_there(each)) continue;
        if (Status status = io::sync_folder(each); !status) return status;
    }
    return Done{};
}

/// Takes the steps that are not taken yet, and removes the journal.
Status take_steps(const fs::path& folder, const CommitJournal& journal) {
    if (Status status = sync_folders(folder, journal); !status) return status;
    for (const auto& [from, to] : journal.renames)
        if (::rename((folder / from).c_str(), (folder / to).c_str()) != 0 && errno != ENOENT)
            return io::write_failure(folder / to, errno);
    for (const std::string& name : journal.removals)
        if (::unlink((folder / name).c_str()) != 0 && errno != ENOENT) return io::write_failure(folder / name, errno);
    if (Status status = sync_folders(folder, journal); !status) return status;
    if (::unlink(journal_file(folder).c_str()) != 0) return io::write_failure(journal_file(folder), errno);
    return Done{};
}

}  // namespace

std::optional<CommitFailure> commit(const fs::path& folder, const CommitJournal& journal) {
    // The temporary names must be on the disk before the journal is, and the journal before the first step.
    Status status = sync_folders(folder, journal);
    if (status) status = write_file_atomically(journal_file(folder), to_json_text(journal));
    if (!status) return CommitFailure{status.error(), false};
    status = take_steps(folder, journal);
    if (status) return std::nullopt;
    return CommitFailure{
        Error{status.error().message +
              "; the new files are complete, and the next command that writes here puts them in place"},
        true};
}

Status finish_commit(const fs::path& folder) {
    if (!is_there(journal_file(folder))) return Done{};
    const auto journal = read_journal(journal_file(folder));
    return journal ? take_steps(folder, *journal) : journal.error();
}

Result<CommittedFolder> CommittedFolder::open(const fs::path& folder) {
    CommittedFolder opened;
    opened.folder_ = folder;
    if (!is_there(journal_file(folder))) return opened;
    auto journal = read_journal(journal_file(folder));
    // A writer may complete the commit at any moment.
    if (!journal) return is_there(journal_file(folder)) ? Result<CommittedFolder>(journal.error()) : opened;
    opened.journal_ = *std::move(journal);
    return opened;
}

fs::path CommittedFolder::path(const std::string& name) const {
    const auto& renames = journal_.renames;
    const auto found = std::find_if(renames.begin(), renames.end(), [&](const auto& r) { return r.to == name; });
    if (found != renames.end() && is_there(folder_ / found->from)) return folder_ / found->from;
    return folder_ / name;
}

}  // namespace lobelia
