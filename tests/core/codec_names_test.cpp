// Tests names of codecs and of their parts: every listed name is made; the error of an unknown one lists the nearest.
#include <gtest/gtest.h>

#include <set>

#include "lobelia/codec.h"

namespace lobelia {
namespace {

TEST(CodecNames, EveryListedCodecIsMadeFromItsName) {
    const auto codecs = all_codecs();
    std::set<std::string> names, pairs;
    for (const CodecName& name : codecs) {
        names.insert(name.str());
        const auto parsed = parse_codec_name(name.str());
        ASSERT_TRUE(parsed);
        EXPECT_EQ(*parsed, name);
        // Make one codec for each basis and encoder: some need quadratures to set up.
        if (!pairs.insert(name.basis + "/" + name.encoder).second) {
            const auto evaluator = make_evaluator(name.evaluator, *make_basis(name.basis).value());
            ASSERT_TRUE(evaluator) << name.str();
            EXPECT_EQ((*evaluator)->name(), name.evaluator);
            continue;
        }
        const auto codec = make_codec(name.str());
        ASSERT_TRUE(codec) << name.str();
        EXPECT_EQ(codec->name(), name);
        EXPECT_EQ(codec->basis().name(), name.basis);
        EXPECT_EQ(codec->evaluator().name(), name.evaluator);
    }
    EXPECT_EQ(names.size(), codecs.size());
    EXPECT_GE(codecs.size(), 100u);
}

TEST(CodecNames, TheListsHoldWhatIsPromised) {
    const auto expect_holds = [](const std::vector<std::string>& list, const std::vector<std::string>& wanted) {
        for (const auto& name : wanted) EXPECT_NE(std::find(list.begin(), list.end(), name), list.end()) << name;
    };
    expect_holds(basis_names(), {"sg12", "sg12h", "sh1", "sh2", "sh3", "sh4", "sh5", "sh6", "sh7", "sh8"});
    expect_holds(encoder_names(),
                 {"projection", "running-average", "running-average-nn", "progressive", "progressive-nn", "moments",
                  "least-squares", "regularised", "matrix-gain", "nnls", "joint", "joint-nn"});
    expect_holds(
        make_basis("sg12").value()->evaluator_names(),
        {"inner-product", "punctual", "hill", "meder", "tokuyoshi", "odd-exact", "odd-exact-2", "polynomial", "exact"});
    expect_holds(make_basis("sh2").value()->evaluator_names(), {"convolution"});
    for (const auto& name : encoder_names()) {
        const auto limit = encoder_limit(name);
        expect_holds(encoder_names(), {limit});
        EXPECT_EQ(encoder_limit(limit), limit);
    }
}

TEST(CodecNames, UnknownNamesGiveTheNearestOnes) {
    const auto expect_error = [](const std::string& name, const std::vector<std::string>& parts) {
        const auto codec = make_codec(name);
        ASSERT_FALSE(codec) << name;
        for (const auto& part : parts)
            EXPECT_NE(codec.error().message.find(part), std::string::npos) << codec.error().message;
    };
    expect_error("sg12/least-squares/hil", {"hil", "hill"});
    expect_error("sg12/least-square/hill", {"least-square", "did you mean least-squares"});
    expect_error("sh9/moments/convolution", {"sh9", "did you mean sh"});
    expect_error("sg13x/moments/hill", {"sg13x", "sg12"});
    expect_error("sh2/moments/hill", {"hill", "sh2"});
    expect_error("sg12/moments/convolution", {"convolution", "sg12"});
    expect_error("sh2/nnls/convolution", {"nnls", "non-negative", "sh2"});
    expect_error("sh1/running-average/convolution", {"running-average", "non-negative"});
    expect_error("sg12/least-squares", {"basis/encoder/evaluator", "sg12/least-squares/"});
    expect_error("sg:lobes.txt/moments/exact", {"command line", "sg{...}"});
    // Nothing near: no suggestion.
    const auto codec = make_codec("xyzzyxyzzyxyzzy/moments/exact");
    ASSERT_FALSE(codec);
    EXPECT_EQ(codec.error().message.find("did you mean"), std::string::npos) << codec.error().message;
}

TEST(CodecNames, FewerThanThreePartsAreRefused) {
    for (const char* name : {"", "/", "sg12", "sg12/", "/hill", "sg12/hill", "hill/"}) {
        const auto parsed = parse_codec_name(name);
        ASSERT_FALSE(parsed) << name;
        EXPECT_NE(parsed.error().message.find("basis/encoder/evaluator"), std::string::npos);
    }
    for (const char* name : {"//", "///", "sg12//", "/moments/hill", "sg12/moments/", "sg12/moments/hill/"})
        EXPECT_FALSE(make_codec(name)) << name;
    // A basis may be a path.
    const auto parsed = parse_codec_name("sg:/a/b.txt/moments/exact");
    ASSERT_TRUE(parsed);
    EXPECT_EQ(*parsed, (CodecName{"sg:/a/b.txt", "moments", "exact"}));
}

}  // namespace
}  // namespace lobelia
