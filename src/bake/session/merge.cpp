// Merges region by region of the whole bake, file by file of the shards: one of each is in memory at a time.
#include "bake/session/merge.h"

#include <fmt/format.h>

#include <algorithm>

#include "bake/session/continuation.h"
#include "bake/session/shard_files.h"

namespace lobelia {
namespace {

class Merger {
  public:
    Merger(const BakeSetup& bake, std::span<const ShardFile> files)
        : bake_(bake), files_(files), place_(bake.map.texels.size()) {}

    [[nodiscard]] Result<RegionStates> merge(std::size_t region) {
        const std::vector<std::uint32_t> texels = bake_.plan.texels(bake_.map, region);
        RegionStates whole(texels.size(), bake_.layout.floats());
        whole.header = expected_header(bake_, region, texels);
        whole.header.end_pass = bake_.plan.end_pass;
        whole.header.instruction_sets = 0;
        std::fill(place_.begin(), place_.end(), k_elsewhere);
        for (std::size_t k = 0; k < texels.size(); ++k) place_[texels[k]] = static_cast<std::uint32_t>(k);
        filled_.assign(texels.size(), false);
        for (const ShardFile& file : files_)
            if (auto status = take(file, whole); !status) return status.error();
        // Count the work of all files once.
        for (const ShardFile& file : files_) {
            if (region > 0) break;
            whole.header.rays += file.header.rays;
            whole.header.seconds += file.header.seconds;
        }
        return whole;
    }

  private:
    static constexpr std::uint32_t k_elsewhere = 0xffffffff;

    /// Adds the part of the region that one file holds.
    [[nodiscard]] Status take(const ShardFile& file, RegionStates& whole) {
        if (file.header.first_pass == file.header.end_pass) return Done{};
        const auto texels = texels_of(bake_.map, file.tiles);
        if (std::all_of(texels.begin(), texels.end(), [&](auto texel) { return place_[texel] == k_elsewhere; }))
            return Done{};
        const auto part = RegionStates::read(file.path);
        if (!part) return part.error();
        if (part->header.end_pass != file.header.end_pass || part->header.sites != texels.size())
            return Error{file.path.string() + ": has changed while it was merged; wait until its bake is done"};
        whole.header.instruction_sets = joined(whole.header.instruction_sets, part->header.instruction_sets);
        const std::size_t floats = bake_.layout.floats();
        for (std::size_t k = 0; k < texels.size(); ++k) {
            const std::uint32_t place = place_[texels[k]];
            if (place == k_elsewhere) continue;
            add(whole.states().subspan(place * floats, floats), part->states().subspan(k * floats, floats),
                !filled_[place]);
            filled_[place] = true;
        }
        return Done{};
    }

    void add(std::span<float> to, std::span<const float> from, bool first) const {
        if (first) {
            std::copy(from.begin(), from.end(), to.begin());
            return;
        }
        const StateLayout& layout = bake_.layout;
        if (bake_.encoding.encoder() != nullptr)
            bake_.encoding.encoder()->merge(layout.encoder(to), layout.encoder(from));
        const auto record = layout.record(to);
        const auto other = layout.record(from);
        for (std::size_t i = 0; i < record.size(); ++i) record[i] += other[i];
    }

    const BakeSetup& bake_;
    std::span<const ShardFile> files_;
    std::vector<std::uint32_t> place_;
    std::vector<bool> filled_;
};

}  // namespace

Status merge_shards(const BakeSetup& bake, std::span<const std::filesystem::path> shards, FilesTogether& files) {
    const auto parts = find_shard_files(bake, shards);
    if (!parts) return parts.error();
    if (auto status = check_whole(bake, *parts); !status) return status;
    Merger merger(bake, *parts);
    for (std::size_t region = 0; region < bake.plan.regions.size(); ++region) {
        if (files.stop().is_set()) return stopped_error();
        auto whole = merger.merge(region);
        if (!whole) return whole.error();
        const auto name = region_file(checkpoint_folder({}), region).string();
        if (auto status = files.add(name, [&](StagedFile& file) { return whole->write(file); }); !status) return status;
    }
    return Done{};
}

}  // namespace lobelia
