// Size and checksum of a file, to tell damaged and foreign files from those that were written.
#pragma once

#include <cstdint>
#include <string>

#include "io/read_file.h"

namespace lobelia {

struct FileSum {
    std::uint64_t size = 0;   ///< [bytes]
    std::uint32_t crc32 = 0;  ///< as in zlib, PNG and zip
    friend bool operator==(const FileSum&, const FileSum&) = default;
};

/// Reads the whole file; errors call it `name`.
[[nodiscard]] Result<FileSum> sum_of(const io::Descriptor& file, const std::string& name);
[[nodiscard]] inline Result<FileSum> sum_of(const InputFile& file) { return sum_of(file.descriptor(), file.name()); }

}  // namespace lobelia
