// Tests the advice: the Pareto front, the budget, the target.
#include "measure/advice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

namespace lobelia {
namespace {

Candidate candidate(const char* basis, double bytes, double error, double nanoseconds = 1) {
    return {{basis, "e", "r"}, "s", bytes, error, nanoseconds};
}

const std::vector<Candidate> k_four = {candidate("a", 4, 0.2), candidate("b", 8, 0.08), candidate("c", 16, 0.03),
                                       candidate("d", 64, 0.02)};

TEST(Advice, WhatIsBeatenIsNotOfTheFront) {
    auto all = k_four;
    all.push_back(candidate("worse", 16, 0.04));
    all.push_back(candidate("same bytes, slower", 16, 0.03, 100));
    all.push_back(candidate("faster", 16, 0.05, 0.1));
    all.push_back(candidate("unknown", 1, std::nan("")));
    const auto advice = advise(all);
    ASSERT_TRUE(advice);
    std::string names;
    for (const Candidate& c : advice->front) names += c.codec.basis + " ";
    EXPECT_EQ(names, "a b c faster d ");
}

TEST(Advice, NothingOfTheFrontBeatsAnythingElse) {
    std::mt19937 generator(1);
    std::uniform_int_distribution<int> number(1, 12);
    std::vector<Candidate> all;
    for (int i = 0; i < 300; ++i)
        all.push_back(candidate("x", number(generator), 0.01 * number(generator), std::exp2(2 * number(generator))));
    const auto advice = advise(all);
    ASSERT_TRUE(advice);
    const auto beats = [](const Candidate& a, const Candidate& b) {
        return a.bytes <= b.bytes && a.error <= b.error && a.nanoseconds <= b.nanoseconds &&
               (a.bytes < b.bytes || a.error < b.error || a.nanoseconds < b.nanoseconds);
    };
    const auto is_beaten = [&](const Candidate& c) {
        return std::any_of(all.begin(), all.end(), [&](const Candidate& other) { return beats(other, c); });
    };
    for (const Candidate& c : advice->front) EXPECT_FALSE(is_beaten(c));
    // Check that each candidate left out is beaten, or has its equal in the front.
    for (const Candidate& c : all)
        EXPECT_TRUE(is_beaten(c) || std::any_of(advice->front.begin(), advice->front.end(), [&](const Candidate& f) {
                        return f.bytes == c.bytes && f.error == c.error && f.nanoseconds == c.nanoseconds;
                    }));
}

TEST(Advice, NoiseInTimesChangesNothing) {
    auto noisy = k_four;
    for (std::size_t i = 0; i < k_four.size(); ++i) {
        noisy[i].nanoseconds = i % 2 == 0 ? 1.9 : 1.1;
        Candidate twin = noisy[i];
        twin.codec.basis += "-twin";
        twin.nanoseconds = 0.9;
        noisy.push_back(twin);
    }
    const auto advice = advise(noisy);
    ASSERT_TRUE(advice);
    EXPECT_EQ(advice->front[advice->recommended].codec.basis, "c");
}

TEST(Advice, TheFewestBytesThatReachTheTarget) {
    const auto recommended = [](const AdviceOptions& options) {
        const auto advice = advise(k_four, options);
        return advice ? advice->front[advice->recommended].codec.basis : advice.error().message;
    };
    EXPECT_EQ(recommended({.target = 0.05}), "c");
    EXPECT_EQ(recommended({.target = 0.1}), "b");
    // The budget rules the target out: expect the least error within the budget.
    EXPECT_EQ(recommended({.budget = 10, .target = 0.05}), "b");
    EXPECT_EQ(recommended({.budget = 100, .target = 0.001}), "d");
    // Nothing reaches the target: expect the least product.
    EXPECT_EQ(recommended({.target = 0.001}), "c");
    EXPECT_NE(recommended({.budget = 3}).find("the smallest is a/e/r in s with 4"), std::string::npos);
    EXPECT_FALSE(advise({}));
}

TEST(Advice, ScriptsGetAllOfIt) {
    const auto advice = advise(k_four, {.budget = 20});
    ASSERT_TRUE(advice);
    const auto j = to_json(*advice);
    EXPECT_EQ(j["front"].size(), 4u);
    EXPECT_EQ(j["recommended"]["codec"], "c/e/r");
    EXPECT_EQ(j["budget"], 20);
    EXPECT_EQ(j["need"], "irradiance");
    // Check that the names equal those of the option.
    EXPECT_EQ(to_json(*advise(k_four, {.need = Need::specular}))["need"], "specular");
    EXPECT_NE(j["reason"].get<std::string>().find("the smallest within 5 %"), std::string::npos);
    EXPECT_EQ(to_study(*advice, "x").tables.at(0).rows.size(), 4u);
}

}  // namespace
}  // namespace lobelia
