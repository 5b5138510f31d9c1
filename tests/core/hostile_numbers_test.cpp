// NaN, infinite, zero and huge directions, samples and coefficients through every public function of every codec: no
// crash, nothing out of bounds, no endless loop. The sanitizers see these tests, and fuzz_api makes the same calls.
#include "hostile_numbers.h"

#include <gtest/gtest.h>

#include "targets.h"

namespace lobelia {
namespace {

using test::k_hostile_numbers;
using test::Numbers;

/// Every listed basis, and lobes of the limits of sharpness.
std::vector<std::shared_ptr<const Basis>> all_bases() {
    std::vector<std::shared_ptr<const Basis>> bases;
    for (const std::string& name : basis_names()) bases.push_back(make_basis(name).value());
    bases.push_back(make_basis("sg{0 0 1 0.01;0 1 0 10000;ambient}").value());
    bases.push_back(make_basis("sgh{0 0 1 0;0.6 0 0.8 1}").value());
    return bases;
}

/// Calls `call` with the whole list from three starts, where one with each number would take too long.
template <class Call>
void for_few_lists(const Call& call) {
    for (std::size_t first = 0; first < 3; ++first) {
        Numbers numbers(k_hostile_numbers, first);
        call(numbers);
    }
}

/// All numbers hostile, from several places in the list; then one among tame ones.
template <class Call>
void for_each_list(const Call& call) {
    for_few_lists(call);
    for (const float hostile : k_hostile_numbers) {
        std::array<float, 61> tame{};
        for (std::size_t i = 0; i < tame.size(); ++i) tame[i] = 0.1f + 0.01f * static_cast<float>(i);
        tame[7] = hostile;
        Numbers numbers(tame);
        call(numbers);
    }
    // Each number alone: everything is NaN, everything is 0.
    for (const float hostile : k_hostile_numbers) {
        Numbers numbers({&hostile, 1});
        call(numbers);
    }
}

TEST(HostileNumbers, EveryBasisReturns) {
    test::on_all_targets([] {
        for (const auto& basis : all_bases()) {
            SCOPED_TRACE(basis->name());
            // A fit is a search of many milliseconds.
            const bool quick = basis->fitted() == nullptr || basis->fitted()->is_continuous();
            if (quick)
                for_each_list([&](Numbers& numbers) { test::call_basis(*basis, numbers); });
            else
                for_few_lists([&](Numbers& numbers) { test::call_basis(*basis, numbers); });
        }
    });
}

TEST(HostileNumbers, EveryEvaluatorReturns) {
    test::on_all_targets([] {
        for (const auto& basis : all_bases())
            for (const std::string& name : basis->evaluator_names()) {
                SCOPED_TRACE(basis->name() + "/" + name);
                const auto evaluator = make_evaluator(name, *basis).value();
                for_each_list([&](Numbers& numbers) { test::call_evaluator(*evaluator, basis->size(), numbers); });
            }
    });
}

TEST(HostileNumbers, EverySpecularEvaluatorReturns) {
    for (const auto& basis : all_bases())
        for (const std::string& name : specular_names(*basis)) {
            SCOPED_TRACE(basis->name() + "/" + name);
            const auto evaluator = make_specular(name, basis).value();
            for_few_lists([&](Numbers& numbers) { test::call_specular(*evaluator, basis->size(), numbers); });
        }
}

TEST(HostileNumbers, EveryEncoderReturns) {
    for (const auto& basis : all_bases())
        for (const std::string& name : encoder_names(*basis)) {
            SCOPED_TRACE(basis->name() + "/" + name);
            const auto encoder = make_encoder(name, basis).value();
            for_few_lists([&](Numbers& numbers) { test::call_encoder(encoder, numbers); });
        }
}

TEST(HostileNumbers, EveryStorageReturns) {
    test::on_all_targets([] {
        const CoefficientTraits traits{4, true, true, {1, 2, 2, 2}};
        for (const Storage& storage : storages()) {
            SCOPED_TRACE(storage.name);
            for_each_list([&](Numbers& numbers) { test::call_storage(storage, traits, numbers); });
        }
    });
}

TEST(HostileNumbers, SamplesAndEnvironmentsReturn) {
    test::on_all_targets([] { for_each_list([](Numbers& numbers) { test::call_samples(numbers); }); });
}

// What the results are, as docs/conventions.md says.
TEST(HostileNumbers, NanCoefficientsGiveNanAndNanDirectionsStayApart) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    for (const auto& basis : all_bases()) {
        SCOPED_TRACE(basis->name());
        const std::vector<Rgb> dark(basis->size());
        Directions directions(2);
        set_entry(directions.view(), 0, Vec3{nan, nan, nan});
        set_entry(directions.view(), 1, Vec3{0, 0, 1});
        Colours out(2);
        basis->radiance(dark, directions, out);
        EXPECT_EQ(colour_at(out.view(), 1), Rgb{}) << "the neighbour of a NaN direction";
        const std::vector<Rgb> all_nan(basis->size(), Rgb{nan, nan, nan});
        EXPECT_TRUE(std::isnan(basis->radiance_at(all_nan, {0, 0, 1}).r));
    }
}

}  // namespace
}  // namespace lobelia
