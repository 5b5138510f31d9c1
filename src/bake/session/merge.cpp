// Merges region by region of the whole bake, file by file of the shards: one of each is in memory at a time.
#include "bake/session/merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "bake/session/checkpoint.h"
#include "io/folders.h"

namespace lobelia {
namespace {

namespace fs = std::filesystem;

/// Lists all files of states in the folders.
Result<std::vector<fs::path>> region_files(std::span<const fs::path> checkpoints) {
    std::vector<fs::path> files;
    for (const fs::path& folder : checkpoints) {
        const std::size_t before = files.size();
        std::error_code code;
        while (fs::exists(region_file(folder, files.size() - before), code))
            files.push_back(region_file(folder, files.size() - before));
        if (files.size() == before) return Error{folder.string() + ": holds no states of a bake"};
    }
    return files;
}

class Merger {
  public:
    Merger(const BakeSetup& bake, const fs::path& checkpoint)
        : bake_(bake), checkpoint_(checkpoint), place_(bake.map.texels.size()) {}

    [[nodiscard]] Status merge_region(std::size_t region, std::span<const fs::path> files) {
        const std::vector<std::uint32_t> texels = bake_.plan.texels(bake_.map, region);
        RegionStates whole(texels.size(), bake_.layout.floats());
        std::fill(place_.begin(), place_.end(), k_elsewhere);
        for (std::size_t k = 0; k < texels.size(); ++k) place_[texels[k]] = static_cast<std::uint32_t>(k);
        passes_.assign(texels.size(), 0);
        seen_.clear();
        for (const fs::path& file : files)
            if (auto status = take(file, whole); !status) return status;

        // Check that every pass covered every texel exactly once.
        const std::uint32_t most = passes_.empty() ? 0 : *std::max_element(passes_.begin(), passes_.end());
        if (most == 0 ||
            std::find_if(passes_.begin(), passes_.end(), [&](auto p) { return p != most; }) != passes_.end())
            return Error{
                "the shards do not make a whole bake: some texels have fewer passes than others; a shard is missing, "
                "unfinished or given twice"};
        whole.header.bake = bake_.hash;
        whole.header.texels = hash_of_texels(texels);
        whole.header.end_pass = most;
        whole.header.samples_per_pass = bake_.options.samples_per_pass;
        whole.header.first_place = bake_.plan.regions[region].first;
        whole.header.end_place = bake_.plan.regions[region].end;
        return whole.write(region_file(checkpoint_, region));
    }

  private:
    static constexpr std::uint32_t k_elsewhere = 0xffffffff;

    /// Adds the part of the region that one file holds.
    [[nodiscard]] Status take(const fs::path& file, RegionStates& whole) {
        auto part = RegionStates::read(file);
        if (!part) return part.error();
        const RegionHeader& h = part->header;
        const auto bad = [&](std::string_view what) { return Error{fmt::format("{}: {}", file.string(), what)}; };
        if (h.bake != bake_.hash) return bad("was baked from another scene or with other options");
        if (!seen_.emplace(h.shard_index, h.first_place).second) return bad("the same part is given twice");
        const Shard shard{h.shard_by == 0 ? Shard::By::tiles : Shard::By::samples, h.shard_index, h.shard_count};
        if (h.shard_count == 0 || h.shard_index >= h.shard_count || h.first_pass > h.end_pass)
            return bad("invalid shard index");
        const auto tiles = tiles_of(bake_.map, shard);
        if (h.first_place > h.end_place || h.end_place > tiles.size()) return bad("invalid tiles");
        const auto texels = texels_of(bake_.map, std::span(tiles).subspan(h.first_place, h.end_place - h.first_place));
        if (h.texels != hash_of_texels(texels) || h.sites != texels.size() || h.floats != bake_.layout.floats() ||
            h.samples_per_pass != bake_.options.samples_per_pass)
            return bad("has different texels or states");

        for (std::size_t k = 0; k < texels.size(); ++k) {
            const std::uint32_t place = place_[texels[k]];
            if (place == k_elsewhere) continue;
            add(whole.states().subspan(place * h.floats, h.floats), part->states().subspan(k * h.floats, h.floats),
                passes_[place] == 0);
            passes_[place] += h.end_pass - h.first_pass;
        }
        whole.header.instruction_sets = joined(whole.header.instruction_sets, h.instruction_sets);
        if (!counted(file)) {
            whole.header.rays += h.rays;
            whole.header.seconds += h.seconds;
        }
        return Done{};
    }

    /// Returns whether a file's rays were counted before, and remembers it.
    bool counted(const fs::path& file) {
        if (std::find(counted_.begin(), counted_.end(), file) != counted_.end()) return true;
        counted_.push_back(file);
        return false;
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
    const fs::path& checkpoint_;
    std::vector<std::uint32_t> place_, passes_;
    std::set<std::pair<std::uint32_t, std::uint32_t>> seen_;  ///< shard and first place of the files taken
    std::vector<fs::path> counted_;
};

}  // namespace

Status merge_shards(const BakeSetup& bake, std::span<const fs::path> shards, const fs::path& checkpoint) {
    const auto files = region_files(shards);
    if (!files) return files.error();
    std::error_code code;
    if (fs::exists(region_file(checkpoint, 0), code))
        return Error{checkpoint.string() + ": holds the states of a bake already; merge into another folder"};
    auto folder = MadeFolder::make(checkpoint);
    if (!folder) return folder.error();

    Merger merger(bake, checkpoint);
    Status status = Done{};
    for (std::size_t region = 0; region < bake.plan.regions.size() && status; ++region)
        status = merger.merge_region(region, *files);
    if (status) {
        folder->keep();
        return status;
    }

    // Leave nothing of a merge that failed.
    for (std::size_t region = 0; region < bake.plan.regions.size(); ++region)
        fs::remove(region_file(checkpoint, region), code);
    return status;
}

}  // namespace lobelia
