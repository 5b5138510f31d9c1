// Size and checksum of a file.
#include "io/file_sum.h"

#include <fmt/format.h>
#include <unistd.h>
#include <zlib.h>

#include <cerrno>
#include <system_error>
#include <vector>

namespace lobelia {

Result<FileSum> sum_of(const io::Descriptor& file, const std::string& name) {
    constexpr std::size_t k_block = std::size_t{1} << 20;
    std::vector<Bytef> block(k_block);
    FileSum sum;
    while (true) {
        const ssize_t count = ::pread(file.get(), block.data(), block.size(), static_cast<off_t>(sum.size));
        if (count < 0 && errno == EINTR) continue;
        if (count < 0)
            return Error{fmt::format("{}: cannot be read: {}", name, std::generic_category().message(errno))};
        if (count == 0) return sum;
        const auto bytes = static_cast<std::size_t>(count);
        sum.crc32 = static_cast<std::uint32_t>(crc32_z(sum.crc32, block.data(), bytes));
        sum.size += bytes;
    }
}

}  // namespace lobelia
