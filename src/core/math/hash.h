// The hash of keys and of content: words of 64 bits, mixed in by multiplication. Not for untrusted parties to agree on.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

namespace lobelia {

static_assert(std::endian::native == std::endian::little, "the bytes of arrays are hashed as little-endian words");

/// Each word is a bijection of the state: two inputs of equal length that differ in one word never collide.
class Hash {
  public:
    void word(std::uint64_t value) {
        // 2^64 over the golden ratio, odd: spreads low bits upwards; the shift brings high bits down again.
        state_ = (state_ ^ value) * 0x9e3779b97f4a7c15u;
        state_ ^= state_ >> 32;
    }
    /// The size, then the bytes.
    void bytes(const void* data, std::size_t size) {
        word(size);
        const auto* next = static_cast<const unsigned char*>(data);
        for (; size >= 8; size -= 8, next += 8) {
            std::uint64_t value = 0;
            std::memcpy(&value, next, 8);
            word(value);
        }
        std::uint64_t rest = 0;
        if (size > 0) std::memcpy(&rest, next, size);
        word(rest);
    }
    [[nodiscard]] std::uint64_t value() const { return state_; }

  private:
    std::uint64_t state_ = 0x6c6f62656c696131u;  ///< "lobelia1": zeros count, too
};

/// Hashes the words of a range of integers.
[[nodiscard]] std::uint64_t hash_of(const auto& words) {
    Hash hash;
    for (const auto word : words) hash.word(static_cast<std::uint64_t>(word));
    return hash.value();
}

}  // namespace lobelia
