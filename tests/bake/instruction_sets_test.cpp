// Bakes whose parts were made with different instruction sets: finished, with a warning that names them.
#include "bake/session/instruction_sets.h"

#include <gtest/gtest.h>

#include "folders.h"
#include "lobelia/bake.h"
#include "lobelia/simd.h"
#include "scene/embedded.h"

namespace lobelia {
namespace {

TEST(InstructionSets, AreJoinedAsSets) {
    EXPECT_EQ(joined(0, 7), 7u);
    EXPECT_EQ(joined(7, 7), 7u);
    EXPECT_FALSE(are_several(joined(7, 7)));
    const InstructionSets both = joined(7, 9);
    EXPECT_TRUE(are_several(both));
    EXPECT_EQ(joined(both, joined(9, 7)), both);
    EXPECT_EQ(joined(joined(both, 11), 13), 0x0d0b0907u);
    EXPECT_EQ(joined(0x0d0b0907u, 15), 0x0d0b0907u) << "a fifth is left out";
}

TEST(InstructionSets, TheWarningNamesThemAndTheWayOut) {
    const std::string warning = several_sets_warning(joined(simd_target_id(), 60));
    EXPECT_NE(warning.find(simd_target()), std::string::npos);
    EXPECT_NE(warning.find("LOBELIA_SIMD"), std::string::npos);
}

BakeJob one_pass_job() {
    BakeJob job;
    job.bake.atlas.width = job.bake.atlas.height = 64;  // several tiles
    job.bake.samples = 16;
    job.bake.paths.bounces = 1;
    job.finish = {Switch::off, Switch::off, Switch::off};
    job.textures.storages.emplace();
    return job;
}

/// Bakes with an instruction set, then uses the fastest again; returns the warnings.
std::vector<std::string> warnings_of(const BakeJob& job, const std::filesystem::path& folder, BakeSession::Start start,
                                     const std::string& target) {
    static const Scene scene = cornell_scene();
    EXPECT_TRUE(use_simd_target(target));
    BakeSession session;
    session.folder = folder;
    session.start = start;
    const auto result = bake(scene, job, session);
    EXPECT_TRUE(use_simd_target(simd_targets().front()));
    EXPECT_TRUE(result) << (result ? "" : result.error().message);
    return result ? result->manifest.warnings : std::vector<std::string>();
}

bool has_warning(const std::vector<std::string>& warnings) {
    return std::any_of(warnings.begin(), warnings.end(),
                       [](const std::string& text) { return text.find("instruction sets") != std::string::npos; });
}

TEST(InstructionSets, ABakeResumedWithAnotherWarns) {
    if (simd_targets().size() < 2) GTEST_SKIP() << "this machine has one instruction set";
    const std::string fastest = simd_targets().front(), plainest = simd_targets().back();
    const test::TestFolder folder("instruction-sets");
    using Start = BakeSession::Start;
    BakeJob job = one_pass_job();
    EXPECT_FALSE(has_warning(warnings_of(job, folder.path() / "bake", Start::fresh, fastest)));
    EXPECT_FALSE(has_warning(warnings_of(job, folder.path() / "bake", Start::resume, fastest)));
    job.bake.samples = 32;
    EXPECT_TRUE(has_warning(warnings_of(job, folder.path() / "bake", Start::resume, plainest)));
    // The states remember it.
    job.bake.samples = 48;
    EXPECT_TRUE(has_warning(warnings_of(job, folder.path() / "bake", Start::resume, plainest)));
}

TEST(InstructionSets, ShardsOfSeveralWarnWhenTheyAreMerged) {
    if (simd_targets().size() < 2) GTEST_SKIP() << "this machine has one instruction set";
    const test::TestFolder folder("instruction-sets");
    const Scene scene = cornell_scene();
    const auto merged = [&](const std::string& name, const std::string& second) {
        std::vector<std::filesystem::path> shards;
        for (std::uint32_t i = 0; i < 2; ++i) {
            BakeJob job = one_pass_job();
            job.bake.shard = {Shard::By::tiles, i, 2};
            shards.push_back(folder.path() / (name + std::to_string(i)));
            static_cast<void>(
                warnings_of(job, shards.back(), BakeSession::Start::fresh, i == 0 ? simd_targets().front() : second));
        }
        BakeSession session;
        session.folder = folder.path() / name;
        const auto result = merge_bake(scene, one_pass_job(), shards, session);
        EXPECT_TRUE(result) << (result ? "" : result.error().message);
        return has_warning(result->manifest.warnings);
    };
    EXPECT_FALSE(merged("same", simd_targets().front()));
    EXPECT_TRUE(merged("mixed", simd_targets().back()));
}

}  // namespace
}  // namespace lobelia
