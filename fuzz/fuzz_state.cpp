// Feeds any bytes to everything that takes a file of states: its reader, the merging of shards, resuming and solving.
// The first byte says how much is made to fit. See CMakeLists.txt for how to run it.
#include <cstring>

#include "bake/session/checkpoint.h"
#include "bake/session/merge.h"
#include "bake/session/regions.h"
#include "bake/session/setup.h"
#include "bake/solve/solve.h"
#include "check_loaded.h"
#include "memory_folder.h"
#include "small_bake.h"
#include "state_input.h"

namespace {

using namespace lobelia;

const BakeSetup& setup() {
    static const Scene scene = small_scene();
    static const auto setup = BakeSetup::make(scene, small_job().bake).value();
    return *setup;
}

/// Writes the states with a valid checksum, behind the header as it is or that of the bake.
void write_states(std::span<const std::byte> bytes, StateInput input, const std::filesystem::path& path) {
    RegionHeader header;
    std::memcpy(&header, bytes.data(), sizeof header);
    const std::size_t floats = (bytes.size() - sizeof header) / sizeof(float);
    const std::size_t texels = setup().map.texels.size(), each = setup().layout.floats();
    RegionStates states = input == StateInput::of_the_bake ? RegionStates(texels, each) : RegionStates(floats, 1);
    const std::size_t taken = std::min(floats, states.states().size()) * sizeof(float);
    if (taken > 0) std::memcpy(states.states().data(), bytes.data() + sizeof header, taken);
    if (input == StateInput::of_the_bake) {
        const RegionHeader whole = states.header;
        states.header = header;
        states.header.bake = setup().hash;
        states.header.texels = hash_of_texels(setup().plan.texels(setup().map, 0));
        states.header.sites = whole.sites;
        states.header.floats = whole.floats;
        states.header.samples_per_pass = setup().options.samples_per_pass;
    } else {
        states.header = header;
    }
    require(static_cast<bool>(states.write(path)));
}

void resume(const std::filesystem::path& checkpoint) {
    BakeSession session;
    session.start = BakeSession::Start::resume;
    RegionGatherer gatherer(setup(), session, checkpoint);
    const auto region = gatherer.gather(0);
    if (!check_result(region)) return;
    const Atlas& atlas = setup().atlas;
    std::vector<LightmapPage> pages(
        atlas.pages(), LightmapPage(atlas.width(), atlas.height(), setup().encoding.page_channels().count()));
    SolveTotals totals;
    solve_onto(pages, atlas, setup().map, {region->texels, region->receivers, region->states.states()},
               setup().encoding, setup().options.samples_per_pass, totals);
    BakeStatistics statistics;
    totals.finish(statistics);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 1) return 0;
    static const MemoryFolder folder;
    const auto input = static_cast<StateInput>(data[0] % 3);
    const auto bytes = bytes_of(data, size).subspan(1);
    const std::filesystem::path file = region_file(checkpoint_folder("part"), 0);
    const std::filesystem::path parts[] = {folder.path() / "part"};
    std::filesystem::create_directories(checkpoint_folder(parts[0]));
    if (input == StateInput::whole_file)
        folder.write(file, bytes);
    else if (bytes.size() >= sizeof(RegionHeader))
        write_states(bytes, input, folder.path() / file);
    else
        return 0;
    check_result(RegionStates::read(folder.path() / file));
    {
        auto merged = FilesTogether::in(folder.path() / "merged");
        require(static_cast<bool>(merged));
        const Status status = merge_shards(setup(), parts, *merged);
        if (!status) require(!status.error().message.empty());
    }
    resume(checkpoint_folder(parts[0]));
    folder.clear();
    return 0;
}
