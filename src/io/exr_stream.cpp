// OpenEXR's streams over a file, over bytes in memory, into a string and into a staged file, with plain bounds checks.
#include "io/exr_stream.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace lobelia::io {

namespace {

[[noreturn]] void throw_truncated() { throw std::runtime_error("the file ends too early"); }

/// Whether `count` bytes lie at `position`; written so that nothing overflows.
bool holds(std::uint64_t size, std::uint64_t position, int count) {
    return count >= 0 && position <= size && static_cast<std::uint64_t>(count) <= size - position;
}

}  // namespace

bool MemoryInput::read(char* target, int count) {
    if (!holds(bytes_.size(), position_, count)) throw_truncated();
    if (count > 0) std::memcpy(target, bytes_.data() + position_, static_cast<std::size_t>(count));
    position_ += static_cast<StreamPosition>(count);
    return position_ < bytes_.size();
}

bool FileInput::read(char* target, int count) {
    if (!holds(size_, position_, count)) throw_truncated();
    const auto bytes = static_cast<std::size_t>(count);
    if (std::fread(target, 1, bytes, file_.get()) != bytes) throw_truncated();
    position_ += static_cast<StreamPosition>(count);
    return position_ < size_;
}

void FileInput::seekg(StreamPosition position) {
    // Positions come from the file itself; those beyond its end fail at the next read.
    if (position <= size_ && fseeko(file_.get(), static_cast<off_t>(position), SEEK_SET) != 0)
        throw std::runtime_error("the file is not seekable");
    position_ = position;
}

void MemoryOutput::write(const char* source, int count) {
    const auto begin = static_cast<std::size_t>(position_), bytes = static_cast<std::size_t>(count);
    if (begin + bytes > bytes_.size()) bytes_.resize(begin + bytes);
    std::copy_n(source, bytes, bytes_.begin() + static_cast<std::ptrdiff_t>(begin));
    position_ += static_cast<StreamPosition>(count);
}

void StagedOutput::require(Status status) {
    if (status_ && !status) status_ = std::move(status);
    if (!status_) throw std::runtime_error(status_.error().message);
}

void StagedOutput::write(const char* source, int count) {
    require(Done{});
    require(file_.write(std::as_bytes(std::span(source, static_cast<std::size_t>(count)))));
    position_ += static_cast<StreamPosition>(count);
}

void StagedOutput::seekp(StreamPosition position) {
    require(file_.seek(position));
    position_ = position;
}

}  // namespace lobelia::io
