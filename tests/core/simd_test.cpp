// The instruction set by name, and by how little results depend on it.
#include "lobelia/simd.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lobelia/lobelia.h"
#include "support.h"

namespace lobelia {
namespace {

/// Uses one instruction set during its lifetime, then the fastest.
class UseTarget {
  public:
    explicit UseTarget(const std::string& name) { EXPECT_TRUE(use_simd_target(name)); }
    ~UseTarget() { EXPECT_TRUE(use_simd_target(simd_targets().front())); }
    UseTarget(const UseTarget&) = delete;
    UseTarget& operator=(const UseTarget&) = delete;
};

TEST(SimdTargets, AreUsedByName) {
    ASSERT_FALSE(simd_targets().empty());
    const std::string fastest = simd_targets().front();
    EXPECT_EQ(simd_target(), fastest);
    for (const std::string& name : simd_targets()) {
        const UseTarget use(name);
        EXPECT_EQ(simd_target(), name);
        EXPECT_EQ(simd_target_name(simd_target_id()), name);
    }
    EXPECT_EQ(simd_target(), fastest);
}

TEST(SimdTargets, AnUnknownNameIsRefusedAndListsTheKnown) {
    const std::string before(simd_target());
    const Status status = use_simd_target("MMX");
    ASSERT_FALSE(status);
    EXPECT_NE(status.error().message.find("\"MMX\""), std::string::npos);
    EXPECT_NE(status.error().message.find(simd_targets().back()), std::string::npos);
    EXPECT_EQ(simd_target(), before);
    EXPECT_EQ(simd_target_name(0), "an unknown instruction set");
    EXPECT_EQ(simd_target_name(60), "an unknown instruction set");
}

std::vector<Rgb> some_coefficients(std::size_t count) {
    std::vector<Rgb> c(count);
    for (std::size_t i = 0; i < count; ++i) {
        const float t = 0.1f * static_cast<float>(i + 1);
        c[i] = {std::sin(t), std::cos(3 * t), std::sin(5 * t)};
    }
    return c;
}

/// Names and results of calculations, as floats.
struct Calculation {
    std::string name;
    std::vector<float> results;
};

std::vector<Calculation> calculations() {
    const Samples samples = texel_samples(sky({32, 16}));
    const Directions directions = test::random_directions(Domain::sphere, 100, 1);
    std::vector<Calculation> all;
    const auto keep = [&](std::string name, const Colours& colours) {
        std::vector<float> floats;
        for (std::size_t k = 0; k < 3; ++k)
            floats.insert(floats.end(), colours.channel(k), colours.channel(k) + colours.size());
        all.push_back({std::move(name), std::move(floats)});
    };
    Colours out(directions.size());
    irradiance_sum(samples, directions, out);
    keep("sum of irradiance", out);
    for (const char* name : {"sh2/moments/convolution", "sh8/moments/convolution", "sg12/least-squares/hill",
                             "sg12/moments/exact", "ambient-cube/moments/exact", "oct8/moments/centroid"}) {
        const Codec codec = make_codec(name).value();
        Accumulator accumulator(codec.encoder());
        accumulator.add(samples);
        all.push_back({name + std::string(": state"), {accumulator.state().begin(), accumulator.state().end()}});
        const std::vector<Rgb> c = some_coefficients(codec.basis().size());
        codec.radiance(c, directions, out);
        keep(name + std::string(": radiance"), out);
        codec.irradiance(c, directions, out);
        keep(name + std::string(": irradiance"), out);
    }
    return all;
}

/// What docs/baking.md says of bits: sums and products differ by rounding, relative to the largest of each calculation.
TEST(SimdTargets, ResultsDifferByRoundingOnly) {
    const auto reference = calculations();
    for (const std::string& name : simd_targets()) {
        const UseTarget use(name);
        const auto here = calculations();
        ASSERT_EQ(here.size(), reference.size());
        for (std::size_t i = 0; i < here.size(); ++i) {
            float largest = 0, difference = 0;
            for (std::size_t j = 0; j < here[i].results.size(); ++j) {
                const float a = here[i].results[j], b = reference[i].results[j];
                largest = std::max(largest, std::abs(b));
                difference = std::max(difference, std::abs(a - b));
            }
            EXPECT_LE(difference, 1e-6f * largest) << name << " " << here[i].name;
        }
    }
}

TEST(SimdTargets, OneTargetGivesTheSameBits) {
    for (const std::string& name : simd_targets()) {
        const UseTarget use(name);
        const auto once = calculations(), again = calculations();
        for (std::size_t i = 0; i < once.size(); ++i) EXPECT_EQ(once[i].results, again[i].results) << name;
    }
}

}  // namespace
}  // namespace lobelia
