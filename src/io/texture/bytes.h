// A buffer of little-endian numbers and texts, as the headers of texture containers have them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace lobelia {

class Bytes {
  public:
    void u32(std::uint64_t value) { number(value, 4); }
    void u64(std::uint64_t value) { number(value, 8); }
    void text(std::string_view text) {
        for (char c : text) data_.push_back(static_cast<std::byte>(c));
    }
    void pad_to(std::size_t multiple) {
        while (data_.size() % multiple != 0) data_.push_back(std::byte{0});
    }
    void append(const Bytes& other) { data_.insert(data_.end(), other.data_.begin(), other.data_.end()); }
    [[nodiscard]] std::size_t size() const { return data_.size(); }
    [[nodiscard]] std::span<const std::byte> data() const { return data_; }

  private:
    void number(std::uint64_t value, int bytes) {
        for (int i = 0; i < bytes; ++i) data_.push_back(static_cast<std::byte>(value >> (8 * i) & 0xff));
    }
    std::vector<std::byte> data_;
};

}  // namespace lobelia
