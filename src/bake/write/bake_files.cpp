// The files of a bake's folder for readers.
#include "bake/write/bake_files.h"

#include <fmt/format.h>

#include <algorithm>

#include "io/file_sum.h"

namespace lobelia {

Result<std::filesystem::path> BakeFiles::checked(const std::string& name) const {
    const std::filesystem::path path = folder_.path(name);
    const auto file = InputFile::open(path, {.links = InputOptions::Links::refused});
    if (!file) return file.error();
    const auto& entries = manifest_.files;
    const auto entry = std::find_if(entries.begin(), entries.end(), [&](const auto& e) { return e.file == name; });
    if (entry == entries.end()) return path;
    const auto sum = sum_of(*file);
    if (!sum) return sum.error();
    if (*sum == FileSum{entry->size, entry->crc32}) return path;
    return Error{
        fmt::format("{}: damaged, or of another bake: {} bytes with CRC-32 {:08x}, but bake.json was written "
                    "with {} bytes and {:08x}; bake again, or if it was changed on purpose, remove its entry "
                    "from \"files\" in bake.json",
                    (folder_.folder() / name).string(), sum->size, sum->crc32, entry->size, entry->crc32)};
}

}  // namespace lobelia
