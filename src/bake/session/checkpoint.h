// The states of one region, in memory and in a file that is written whole or not at all, with a checksum.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "bake/session/instruction_sets.h"
#include "io/read_file.h"
#include "io/staged_file.h"
#include "lobelia/result.h"

namespace lobelia {

/// The bake that a file of states belongs to, and its progress.
struct RegionHeader {
    std::uint64_t bake = 0;        ///< state_hash
    std::uint64_t texels = 0;      ///< hash_of_texels
    std::uint64_t sites = 0;       ///< number of texels
    std::uint32_t floats = 0;      ///< per texel
    std::uint32_t first_pass = 0;  ///< passes [first_pass, end_pass) are done
    std::uint32_t end_pass = 0;
    std::uint32_t samples_per_pass = 0;
    std::uint32_t shard_by = 0, shard_index = 0, shard_count = 1;  ///< Shard
    std::uint32_t first_place = 0, end_place = 0;                  ///< tiles: places in the plan's list
    InstructionSets instruction_sets = 0;                          ///< that the states were made with
    std::uint64_t rays = 0;
    double seconds = 0;
};

/// Header and states in one allocation, so that they are written without a copy.
class RegionStates {
  public:
    RegionStates() = default;
    RegionStates(std::size_t sites, std::size_t floats_each);

    RegionHeader header;
    [[nodiscard]] std::span<float> states();
    [[nodiscard]] std::span<const float> states() const;

    /// Writes the file atomically and replaces an older one.
    [[nodiscard]] Status write(const std::filesystem::path& path);
    [[nodiscard]] Status write(StagedFile& file);
    /// Errors name the file and what is wrong: cut off, damaged, of another version.
    [[nodiscard]] static Result<RegionStates> read(const std::filesystem::path& path);
    /// Reads the header alone, without the checksum over the states.
    [[nodiscard]] static Result<RegionHeader> read_header(const std::filesystem::path& path);

  private:
    /// Returns the file's bytes, with the header in them.
    [[nodiscard]] std::span<const std::byte> sealed();

    std::vector<float> storage_;
};

/// Returns the folder of a bake's states.
[[nodiscard]] inline std::filesystem::path checkpoint_folder(const std::filesystem::path& bake) {
    return bake / "checkpoint";
}
/// Opens a file in the checkpoint of a bake's folder: neither it nor the checkpoint may be a symbolic link, because the
/// bake's folder is all that the user named.
[[nodiscard]] Result<InputFile> open_in_checkpoint(
    const std::filesystem::path& path, std::uint64_t most_bytes = std::numeric_limits<std::uint64_t>::max());
[[nodiscard]] std::filesystem::path region_file(const std::filesystem::path& checkpoint, std::size_t region);
/// Returns the names of the files of states in a bake's folder, relative to it.
[[nodiscard]] std::vector<std::string> region_names(const std::filesystem::path& bake);

}  // namespace lobelia
