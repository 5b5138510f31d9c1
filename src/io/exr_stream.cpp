// OpenEXR's streams: from files and memory, into strings and staged files, with plain bounds checks.
#include "io/exr_stream.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace lobelia::io {

namespace {

[[noreturn]] void throw_truncated() { throw std::runtime_error("the file ends too early"); }

/// Returns true if `count` bytes lie at `position`; written so that nothing overflows.
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
    if (!holds(size(), position_, count)) throw_truncated();
    const std::span bytes(target, static_cast<std::size_t>(count));
    if (const Status status = file_.read(position_, std::as_writable_bytes(bytes)); !status)
        throw std::runtime_error(status.error().message);
    position_ += static_cast<StreamPosition>(count);
    return position_ < size();
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
