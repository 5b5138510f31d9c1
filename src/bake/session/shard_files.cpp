// The files of states of a bake's shards, and whether they make a whole.
#include "bake/session/shard_files.h"

#include <fmt/format.h>

#include <algorithm>

#include "io/commit_journal.h"
#include "io/counted.h"

namespace lobelia {
namespace {

namespace fs = std::filesystem;

Result<ShardFile> read_shard_file(const BakeSetup& bake, const fs::path& folder, const fs::path& path) {
    const auto header = RegionStates::read_header(path);
    if (!header) return header.error();
    const RegionHeader& h = *header;
    const auto bad = [&](std::string_view what) { return Error{fmt::format("{}: {}", path.string(), what)}; };
    if (h.bake != bake.hash) return bad("belongs to another scene or other options");
    if (h.shard_count == 0 || h.shard_index >= h.shard_count || h.first_pass > h.end_pass)
        return bad("invalid shard index");
    const auto tiles =
        tiles_of(bake.map, {h.shard_by == 0 ? Shard::By::tiles : Shard::By::samples, h.shard_index, h.shard_count});
    if (h.first_place > h.end_place || h.end_place > tiles.size()) return bad("invalid tiles");
    ShardFile file{path, folder, h, {tiles.begin() + h.first_place, tiles.begin() + h.end_place}};
    const auto texels = texels_of(bake.map, file.tiles);
    if (h.texels != hash_of_texels(texels) || h.sites != texels.size() || h.floats != bake.layout.floats() ||
        h.samples_per_pass != bake.options.samples_per_pass)
        return bad("has other texels or states than this bake");
    return file;
}

/// "passes 4 to 7", counted from 0.
std::string passes_text(std::uint32_t first, std::uint32_t end) {
    return end - first == 1 ? fmt::format("pass {}", first) : fmt::format("passes {} to {}", first, end - 1);
}

/// Finds what is wrong with the passes of a tile, from its files in the order of their first pass. Empty: nothing.
std::string fault_of(std::span<const ShardFile* const> files, std::uint32_t passes) {
    std::uint32_t end = 0;
    const ShardFile* before = nullptr;
    for (const ShardFile* file : files) {
        const RegionHeader& h = file->header;
        if (h.first_pass == h.end_pass) continue;
        if (h.end_pass > passes)
            return fmt::format("{} has {}, more than the {} of the first folder's job", file->folder.string(),
                               passes_text(h.first_pass, h.end_pass), passes);
        if (h.first_pass < end)
            return fmt::format("given twice: {} of {}, by {} and by {}",
                               passes_text(h.first_pass, std::min(end, h.end_pass)), passes, before->folder.string(),
                               file->folder.string());
        if (h.first_pass > end) break;
        end = h.end_pass;
        before = file;
    }
    if (end == passes) return {};
    const auto next =
        std::find_if(files.begin(), files.end(), [&](const auto* f) { return f->header.first_pass > end; });
    return fmt::format("missing: {} of {}{}",
                       passes_text(end, next == files.end() ? passes : (*next)->header.first_pass), passes,
                       before == nullptr ? "" : ", after those of " + before->folder.string());
}

/// Lists what was given, for the error.
std::string given(std::span<const ShardFile> files) {
    constexpr std::size_t k_most = 8;
    std::string text;
    std::vector<fs::path> listed;
    for (const ShardFile& file : files) {
        const RegionHeader& h = file.header;
        if (std::find(listed.begin(), listed.end(), file.folder) != listed.end()) continue;
        if (listed.size() == k_most) return text + ", ...";
        listed.push_back(file.folder);
        text += fmt::format("{}{} is shard {}/{} by {} with {}", text.empty() ? "" : "; ", file.folder.string(),
                            h.shard_index, h.shard_count, h.shard_by == 0 ? "tiles" : "samples",
                            h.first_pass == h.end_pass ? "no pass" : passes_text(h.first_pass, h.end_pass));
    }
    return text;
}

}  // namespace

Result<std::vector<ShardFile>> find_shard_files(const BakeSetup& bake, std::span<const fs::path> shards) {
    std::vector<ShardFile> files;
    for (const fs::path& folder : shards) {
        const auto committed = CommittedFolder::open(folder);
        if (!committed) return committed.error();
        const auto names = region_names(folder);
        if (names.empty()) return Error{folder.string() + ": holds no states of a bake"};
        for (const std::string& name : names) {
            auto file = read_shard_file(bake, folder, committed->path(name));
            if (!file) return file.error();
            files.push_back(*std::move(file));
        }
    }
    // Sums of samples then do not depend on the order of the folders.
    std::stable_sort(files.begin(), files.end(),
                     [](const auto& a, const auto& b) { return a.header.first_pass < b.header.first_pass; });
    return files;
}

Status check_whole(const BakeSetup& bake, std::span<const ShardFile> files) {
    const std::uint32_t passes = bake.plan.end_pass;
    std::vector<std::vector<const ShardFile*>> of_tile(bake.map.first_of_tile.size() - 1);
    for (const ShardFile& file : files)
        for (const std::uint32_t tile : file.tiles) of_tile[tile].push_back(&file);
    std::string first;
    std::size_t faults = 0;
    for (const auto& tile : of_tile) {
        const std::string fault = fault_of(tile, passes);
        if (!fault.empty() && faults++ == 0) first = fault;
    }
    if (faults == 0) return Done{};
    return Error{
        fmt::format("the shards do not make a whole bake: {}, in {} of {}. {}. Continue an unfinished shard: "
                    "lobelia bake --resume -o FOLDER; bake a missing one with --shard; give each once",
                    first, faults, counted(of_tile.size(), "tile"), given(files))};
}

}  // namespace lobelia
