// Tests that codecs and storages are chosen by name, and that summaries show one row for each basis.
#include "measure/compare_job.h"

#include <gtest/gtest.h>

#include <set>

#include "measure/comparison_text.h"
#include "support.h"

namespace lobelia {
namespace {

std::string message(const CodecFilter& filter) {
    const auto codecs = chosen_codecs(filter);
    return codecs ? std::string() : codecs.error().message;
}

TEST(CodecFilter, AnEmptyOneChoosesEveryListedCodec) {
    const auto chosen = chosen_codecs({});
    ASSERT_TRUE(chosen);
    std::set<std::string> names, listed;
    for (const CodecName& name : *chosen) EXPECT_TRUE(names.insert(name.str()).second) << name.str();
    for (const CodecName& name : all_codecs()) listed.insert(name.str());
    EXPECT_EQ(names, listed);
}

TEST(CodecFilter, FiltersMultiply) {
    const auto chosen = chosen_codecs({.bases = {"sg12", "sh2", "sg12"}, .encoders = {"moments", "nnls"}});
    ASSERT_TRUE(chosen);
    for (const CodecName& name : *chosen) {
        EXPECT_TRUE(name.basis == "sg12" || name.basis == "sh2");
        EXPECT_TRUE(name.encoder == "moments" || name.encoder == "nnls");
    }
    EXPECT_EQ(chosen_codecs({.codecs = {"sh1/moments/convolution", "sh1/moments/convolution"}})->size(), 1u);
}

TEST(CodecFilter, UnknownNamesAreRefused) {
    EXPECT_NE(message({.codecs = {"sh1/moment/convolution"}}).find("moments"), std::string::npos);
    EXPECT_NE(message({.bases = {"sgg12"}}).find("sg12"), std::string::npos);
    EXPECT_NE(message({.encoders = {"nnl"}}).find("unknown encoder \"nnl\""), std::string::npos);
    EXPECT_NE(message({.evaluators = {"hil"}}).find("unknown evaluator \"hil\""), std::string::npos);
    EXPECT_NE(message({.bases = {"sh1"}, .evaluators = {"hill"}}).find("hill"), std::string::npos);
}

TEST(CompareJob, NamesAreCheckedBeforeAnyWork) {
    CompareJob job;
    job.storages = {"float61"};
    const auto status = check(job);
    ASSERT_FALSE(status);
    EXPECT_NE(status.error().message.find("float61"), std::string::npos);
}

TEST(CompareJob, AStorageThatNoCodecCanUseIsRefused) {
    CompareJob job;
    job.codecs.codecs = {"sh1/moments/convolution"};
    job.storages = {"rgbe"};
    job.options.pictures = job.options.convergence = false;
    const auto result = compare(test::small_sky(), job);
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find("rgbe"), std::string::npos);
}

TEST(ComparisonText, ShowsTheBestCodecOfEachBasisInPerCentOfTheMean) {
    CompareJob job;
    job.codecs.bases = {"sh1", "sg12"};
    job.options.pictures = job.options.convergence = false;
    const auto result = compare(test::small_sky(), job);
    ASSERT_TRUE(result);
    const std::string text = summary_text(*result);
    // A heading, two bases, the note.
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 4);
    for (const char* basis : {"sh1", "sg12"}) {
        const Method* best = nullptr;
        for (const Method& m : result->methods)
            if (m.name.basis == basis && (best == nullptr || m.irradiance_over_pi.rms < best->irradiance_over_pi.rms))
                best = &m;
        EXPECT_NE(text.find(best->name.str() + " "), std::string::npos) << text;
    }
    EXPECT_NE(text.find(" % "), std::string::npos);
    EXPECT_TRUE(stored_text(*result).empty());
}

}  // namespace
}  // namespace lobelia
