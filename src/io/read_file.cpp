// Files read whole, into memory.
#include "io/read_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

namespace lobelia {

namespace {

template <class Bytes>
Result<Bytes> read_whole(const std::filesystem::path& path, std::size_t most_bytes) {
    // Ask for the kind and the size before opening: a pipe would wait for ever.
    const std::string name = path.string();
    const auto failed = [&](int code) {
        return Error{fmt::format("{}: cannot be read: {}", name, std::generic_category().message(code))};
    };
    std::error_code code;
    const auto status = std::filesystem::status(path, code);
    if (!std::filesystem::exists(status)) return failed(code ? code.value() : ENOENT);
    if (!std::filesystem::is_regular_file(status)) return Error{fmt::format("{}: not a regular file", name)};
    const std::uintmax_t size = std::filesystem::file_size(path, code);
    if (code) return failed(code.value());
    if (size > most_bytes) return Error{fmt::format("{}: {} bytes; at most {} are read", name, size, most_bytes)};

    // Read what was promised, and see that it is all.
    errno = 0;
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
    if (!file) return failed(errno);
    Bytes bytes(size, {});
    if (std::fread(bytes.data(), 1, bytes.size(), file.get()) != bytes.size() || std::fgetc(file.get()) != EOF)
        return std::ferror(file.get()) ? failed(errno) : Error{fmt::format("{}: changed while it was read", name)};
    return bytes;
}

}  // namespace

Result<std::vector<std::byte>> read_file(const std::filesystem::path& path, std::size_t most_bytes) {
    return read_whole<std::vector<std::byte>>(path, most_bytes);
}

Result<std::string> read_text(const std::filesystem::path& path, std::size_t most_mebibytes) {
    return read_whole<std::string>(path, most_mebibytes << 20);
}

}  // namespace lobelia
