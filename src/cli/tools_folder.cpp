#include "cli/tools_folder.h"

#include <fmt/core.h>

#include <cstdlib>
#include <vector>

#include "cli/process.h"

namespace lobelia::cli {

Result<std::filesystem::path> tools_folder() {
    std::vector<std::filesystem::path> folders;
    if (const char* named = std::getenv("LOBELIA_TOOLS")) folders.emplace_back(named);
    for (const char* relative : {"../share/lobelia/tools", "../../tools", "../tools"})
        folders.push_back((program_folder() / relative).lexically_normal());
    std::error_code code;
    for (const auto& folder : folders)
        if (std::filesystem::exists(folder / "unwrap.mjs", code)) return folder;
    return Error{
        fmt::format("unwrap.mjs is not found in {}; set LOBELIA_TOOLS to its folder", folders.front().string())};
}

}  // namespace lobelia::cli
