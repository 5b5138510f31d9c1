// Whether the checkpoint in a folder can be continued by a bake.
#include "bake/session/continuation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bake/session/job_file.h"
#include "lobelia/simd.h"

namespace lobelia {
namespace {

namespace fs = std::filesystem;

/// An error if more samples than those of the job that is kept are requested before the states hold all of its own.
Status check_more_samples(const BakeSetup& setup, const fs::path& folder, const BakeJob& kept, std::uint32_t done) {
    const BakeOptions& options = setup.options;
    if (options.samples <= kept.bake.samples) return Done{};
    if (options.shard.by == Shard::By::samples && options.shard.count > 1)
        return Error{folder.string() +
                     ": a shard of samples cannot get more of them: merge the shards, and add samples to the whole"};
    if (done >= passes_of(kept.bake, kept.bake.shard).end) return Done{};
    return Error{fmt::format(
        "{}: its states hold {} samples of {}, to which no more are added; complete it first: "
        "lobelia bake --resume -o {}",
        folder.string(), std::uint64_t{done} * options.samples_per_pass, kept.bake.samples, folder.string())};
}

}  // namespace

RegionHeader expected_header(const BakeSetup& setup, std::size_t region, std::span<const std::uint32_t> texels) {
    const BakePlan& plan = setup.plan;
    const BakeOptions& options = setup.options;
    RegionHeader header;
    header.bake = setup.hash;
    header.texels = hash_of_texels(texels);
    header.sites = texels.size();
    header.floats = static_cast<std::uint32_t>(setup.layout.floats());
    header.first_pass = header.end_pass = plan.first_pass;
    header.samples_per_pass = options.samples_per_pass;
    header.shard_by = static_cast<std::uint32_t>(options.shard.by);
    header.shard_index = options.shard.index;
    header.shard_count = options.shard.count;
    header.first_place = plan.regions[region].first;
    header.end_place = plan.regions[region].end;
    header.instruction_sets = simd_target_id();
    return header;
}

Status check_header(const fs::path& file, const RegionHeader& is, const RegionHeader& expected) {
    if (is.bake != expected.bake)
        return Error{file.string() +
                     ": belongs to another scene or other options; bake into another folder, or remove it"};
    if (is.texels != expected.texels || is.sites != expected.sites || is.floats != expected.floats ||
        is.samples_per_pass != expected.samples_per_pass || is.first_pass != expected.first_pass ||
        is.end_pass < is.first_pass)
        return Error{file.string() +
                     ": was made with another --memory, --shard or --samples-per-pass; use the same again"};
    return Done{};
}

Status check_continuation(const BakeSetup& setup, const fs::path& folder) {
    // Check what is there, and find the number of passes that all regions have.
    const fs::path checkpoint = checkpoint_folder(folder);
    std::uint32_t done = ~std::uint32_t{0};
    bool any = false;
    for (std::size_t region = 0; region < setup.plan.regions.size(); ++region) {
        const fs::path file = region_file(checkpoint, region);
        std::error_code code;
        if (!fs::exists(file, code)) {
            done = setup.plan.first_pass;
            continue;
        }
        const auto header = RegionStates::read_header(file);
        if (!header) return header.error();
        const auto texels = setup.plan.texels(setup.map, region);
        if (auto status = check_header(file, *header, expected_header(setup, region, texels)); !status) return status;
        done = std::min(done, header->end_pass);
        any = true;
    }
    if (!holds_job(folder)) return Done{};
    const auto kept = read_kept_job(folder);
    if (!kept) return kept.error();
    if (!any && kept->rebaked)
        return Error{
            fmt::format("{}: its states were removed when objects were baked again ({}): the bake is complete, and "
                        "there is nothing to continue; bake all of it into another folder, or remove {} first",
                        folder.string(), fmt::join(*kept->rebaked, ", "), checkpoint.string())};
    return check_more_samples(setup, folder, kept->job, done);
}

Error earlier_checkpoint(const fs::path& folder) {
    return Error{
        fmt::format("{}: holds the states of an earlier bake; continue it: lobelia bake --resume -o {}; or "
                    "remove them",
                    checkpoint_folder(folder).string(), folder.string())};
}

}  // namespace lobelia
