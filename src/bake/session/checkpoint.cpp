// Files of states. All numbers are little-endian, as in memory.
#include "bake/session/checkpoint.h"

#include <fmt/format.h>
#include <zlib.h>

#include <bit>
#include <cstring>

#include "io/write_file.h"

namespace lobelia {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::array<char, 8> k_magic{'L', 'O', 'B', 'S', 'T', 'A', 'T', 'E'};
constexpr std::uint32_t k_checkpoint_version = 2;

/// The beginning of the file.
struct FileHeader {
    std::array<char, 8> magic = k_magic;
    std::uint32_t version = k_checkpoint_version;
    std::uint32_t checksum = 0;  ///< CRC-32 of the region header and the states
    RegionHeader region;
};
constexpr std::size_t k_header_floats = 64;
static_assert(sizeof(FileHeader) <= k_header_floats * sizeof(float));

std::uint32_t checksum(const RegionHeader& header, std::span<const float> states) {
    uLong crc = crc32_z(0, reinterpret_cast<const Bytef*>(&header), sizeof header);
    crc = crc32_z(crc, reinterpret_cast<const Bytef*>(states.data()), states.size_bytes());
    return static_cast<std::uint32_t>(crc);
}

/// Reads and checks the beginning of a file.
Result<FileHeader> read_start(const InputFile& file) {
    const auto bad = [&](std::string_view what) { return Error{fmt::format("{}: {}", file.name(), what)}; };
    FileHeader start;
    std::array<std::byte, k_header_floats * sizeof(float)> begin{};
    if (file.size() < begin.size()) return bad("this checkpoint is truncated");
    if (const Status status = file.read(0, begin); !status) return status.error();
    std::memcpy(&start, begin.data(), sizeof start);
    if (start.magic != k_magic) return bad("this is not a checkpoint of Lobelia");
    if (start.version != k_checkpoint_version)
        return bad(fmt::format("this checkpoint has version {}; this program reads version {}", start.version,
                               k_checkpoint_version));
    constexpr std::uint64_t most_floats = std::uint64_t{1} << 40;
    const RegionHeader& region = start.region;
    if (region.floats == 0 || region.sites > most_floats / region.floats ||
        file.size() != sizeof(float) * (k_header_floats + region.sites * region.floats))
        return bad("this checkpoint is truncated or damaged: its size does not match its header");
    return start;
}

std::string region_name(std::size_t region) { return fmt::format("region-{:04}.state", region); }

}  // namespace

RegionStates::RegionStates(std::size_t sites, std::size_t floats_each)
    : storage_(k_header_floats + sites * floats_each) {
    header.sites = sites;
    header.floats = static_cast<std::uint32_t>(floats_each);
}

std::span<float> RegionStates::states() { return std::span(storage_).subspan(k_header_floats); }
std::span<const float> RegionStates::states() const { return std::span(storage_).subspan(k_header_floats); }

std::span<const std::byte> RegionStates::sealed() {
    FileHeader file;
    file.region = header;
    file.checksum = checksum(header, states());
    std::memcpy(storage_.data(), &file, sizeof file);
    return std::as_bytes(std::span(storage_));
}

Status RegionStates::write(const std::filesystem::path& path) { return write_file_atomically(path, sealed()); }
Status RegionStates::write(StagedFile& file) { return file.write(sealed()); }

Result<RegionHeader> RegionStates::read_header(const std::filesystem::path& path) {
    const auto file = open_in_checkpoint(path);
    if (!file) return file.error();
    const auto start = read_start(*file);
    return start ? Result<RegionHeader>(start->region) : start.error();
}

Result<RegionStates> RegionStates::read(const std::filesystem::path& path) {
    // Read the header first: allocate nothing for a file that is not a checkpoint.
    const auto file = open_in_checkpoint(path);
    if (!file) return file.error();
    const auto start = read_start(*file);
    if (!start) return start.error();
    const RegionHeader& region = start->region;
    RegionStates result(region.sites, region.floats);
    result.header = region;
    const auto states = result.states();
    if (const Status status = file->read(k_header_floats * sizeof(float), std::as_writable_bytes(states)); !status)
        return status.error();
    if (checksum(region, states) != start->checksum)
        return Error{file->name() + ": this checkpoint is damaged: its checksum is wrong"};
    return result;
}

Result<InputFile> open_in_checkpoint(const std::filesystem::path& path, std::uint64_t most_bytes) {
    const auto checkpoint = path.parent_path();
    return InputFile::open_below(checkpoint.parent_path(), checkpoint.filename() / path.filename(), most_bytes);
}

std::filesystem::path region_file(const std::filesystem::path& checkpoint, std::size_t region) {
    return checkpoint / region_name(region);
}

std::vector<std::string> region_names(const std::filesystem::path& bake) {
    std::vector<std::string> names;
    std::error_code code;
    const std::filesystem::path folder = checkpoint_folder(bake);
    while (std::filesystem::exists(region_file(folder, names.size()), code))
        names.push_back((folder.filename() / region_name(names.size())).string());
    return names;
}

}  // namespace lobelia
