// The states of one region as they are kept in memory and in a file: written whole or not at all, with a checksum.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "lobelia/result.h"

namespace lobelia {

/// What a file of states belongs to, and how far it is.
struct RegionHeader {
    std::uint64_t bake = 0;        ///< state_hash
    std::uint64_t texels = 0;      ///< hash of the texel indices, in order
    std::uint64_t sites = 0;       ///< number of texels
    std::uint32_t floats = 0;      ///< of each
    std::uint32_t first_pass = 0;  ///< the passes that are in
    std::uint32_t end_pass = 0;
    std::uint32_t samples_per_pass = 0;
    std::uint32_t shard_by = 0, shard_index = 0, shard_count = 1;  ///< Shard
    std::uint32_t first_place = 0, end_place = 0;                  ///< tiles: places in the shard's list
    std::uint32_t reserved = 0;
    std::uint64_t rays = 0;
    double seconds = 0;
};

/// One allocation that starts with the file's header, so that it can be written as it is.
class RegionStates {
  public:
    RegionStates() = default;
    RegionStates(std::size_t sites, std::size_t floats_each);

    RegionHeader header;
    [[nodiscard]] std::span<float> states();
    [[nodiscard]] std::span<const float> states() const;

    /// Atomically, over what is there.
    [[nodiscard]] Status write(const std::filesystem::path& path);
    /// Errors name the file and what is wrong: cut off, damaged, of another version.
    [[nodiscard]] static Result<RegionStates> read(const std::filesystem::path& path);

  private:
    std::vector<float> storage_;
};

[[nodiscard]] std::filesystem::path region_file(const std::filesystem::path& folder, std::size_t region);

}  // namespace lobelia
