// Text files, whole.
#include "io/read_text.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <system_error>

namespace lobelia {

Result<std::string> read_text(const std::filesystem::path& path, std::uintmax_t most_mebibytes) {
    const std::string name = path.string();
    std::error_code code;
    if (!std::filesystem::exists(path, code)) return Error{name + ": no such file"};
    if (!std::filesystem::is_regular_file(path, code)) return Error{name + ": not a regular file"};
    if (std::filesystem::file_size(path, code) > most_mebibytes << 20)
        return Error{fmt::format("{}: larger than {} MiB", name, most_mebibytes)};
    std::ifstream file(path, std::ios::binary);
    if (!file) return Error{name + ": cannot be opened"};
    std::string text{std::istreambuf_iterator<char>(file), {}};
    if (file.bad()) return Error{name + ": cannot be read"};
    return text;
}

}  // namespace lobelia
