// Tests that every kernel, basis and evaluator gives the same results with every compiled instruction set that this
// machine has, down to scalar code if it was compiled too (HWY_COMPILE_ALL_ATTAINABLE).
#include "core/math/kernels.h"

#include <gtest/gtest.h>

#include <functional>

#include "lobelia/codec.h"
#include "lobelia/specular.h"
#include "support.h"
#include "targets.h"

namespace lobelia {
namespace {

using Run = std::function<std::vector<float>()>;

/// Checks that the result of `run` agrees between all targets to 1e-6 of its largest magnitude, or of `least_scale`.
void expect_equal_on_all_targets(const Run& run, const std::string& what, double least_scale = 0) {
    const std::vector<float> expected = run();
    double scale = least_scale;
    for (const float v : expected) scale = std::max(scale, static_cast<double>(std::abs(v)));
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        const test::OnlyTargets only(target);
        const std::vector<float> found = run();
        ASSERT_EQ(found.size(), expected.size());
        double worst = 0;
        for (std::size_t i = 0; i < found.size(); ++i) {
            const double d = std::abs(static_cast<double>(found[i]) - expected[i]);
            worst = d <= worst ? worst : d;
        }
        EXPECT_LE(worst, 1e-6 * scale) << what << " with " << hwy::TargetName(target);
    }
}

std::vector<float> flat(ColourView colours) {
    std::vector<float> result;
    for (std::size_t k = 0; k < 3; ++k)
        result.insert(result.end(), colours.channel(k), colours.channel(k) + colours.size);
    return result;
}

/// Samples of a smooth environment, of unequal solid angles.
Samples smooth_samples(std::size_t count) {
    const Samples even = test::samples_of(
        Domain::sphere, count,
        [](Vec3 d) {
            return Rgb{1 + d.x, std::exp(d.y), 0.5f + d.z * d.z};
        },
        Sequence::random);
    Samples result(count);
    for (std::size_t i = 0; i < count; ++i) {
        RadianceSample s = even[i];
        s.solid_angle *= 0.5f + 0.1f * static_cast<float>(i % 10);
        result.set(i, s);
    }
    return result;
}

/// Function values of sg12 in rows, for blocks of any size.
std::vector<float> rows_of(DirectionView block) {
    static const auto basis = as_linear(make_basis("sg12").value());
    std::vector<float> rows(12 * k_block_size, 0.0f);
    basis->values(block, rows.data());
    return rows;
}

constexpr std::array<std::size_t, 7> k_sizes = {1, 3, 15, 16, 17, 100, 256};

TEST(Kernels, SeveralTargetsAreTested) {
    const auto targets = hwy::SupportedAndGeneratedTargets();
    ASSERT_FALSE(targets.empty());
    std::string names;
    for (const std::int64_t target : targets) names += std::string(" ") + hwy::TargetName(target);
    RecordProperty("targets", names);
#ifdef HWY_COMPILE_ALL_ATTAINABLE
    EXPECT_TRUE(targets.back() == HWY_EMU128 || targets.back() == HWY_SCALAR) << "no scalar code among" << names;
#endif
}

TEST(Kernels, IrradianceSumIsTheSameOnAllTargets) {
    for (const std::size_t count : {1, 17, 1000, 5000})
        for (const std::size_t normals : {1, 4, 19}) {
            const Samples samples = smooth_samples(count);
            const Directions n = test::random_directions(Domain::sphere, normals, 3);
            expect_equal_on_all_targets(
                [&] {
                    Colours out(normals);
                    irradiance_sum(samples, n, out);
                    return flat(out);
                },
                "irradiance_sum of " + std::to_string(count));
        }
}

TEST(Kernels, MomentsAndGramAreTheSameOnAllTargets) {
    for (const std::size_t size : k_sizes) {
        const Samples samples = smooth_samples(size);
        const auto rows = rows_of(samples.view().directions());
        for (const std::size_t count : {1, 3, 4, 12}) {
            expect_equal_on_all_targets(
                [&] {
                    std::vector<float> sums(3 * count + 1);
                    sums.back() = kernels::add_moments(rows.data(), count, samples, sums.data());
                    return sums;
                },
                "add_moments");
            expect_equal_on_all_targets(
                [&] {
                    std::vector<float> sums(count * (count + 1) / 2);
                    kernels::add_gram(rows.data(), count, samples, sums.data());
                    return sums;
                },
                "add_gram");
        }
    }
}

TEST(Kernels, MomentsAndGramAreTheirSums) {
    for (const std::size_t size : k_sizes) {
        const Samples samples = smooth_samples(size);
        const auto rows = rows_of(samples.view().directions());
        constexpr std::size_t count = 5;
        std::vector<float> moments(3 * count, 1.0f), gram(count * (count + 1) / 2, 1.0f);
        const float total = kernels::add_moments(rows.data(), count, samples, moments.data());
        kernels::add_gram(rows.data(), count, samples, gram.data());
        double expected_total = 0;
        for (std::size_t j = 0; j < size; ++j) expected_total += samples[j].solid_angle;
        EXPECT_NEAR(total, expected_total, 1e-6 * expected_total);
        std::size_t next = 0;
        for (std::size_t i = 0; i < count; ++i) {
            double red = 1;
            for (std::size_t j = 0; j < size; ++j)
                red += static_cast<double>(samples[j].solid_angle) * rows[i * k_block_size + j] * samples[j].radiance.r;
            EXPECT_NEAR(moments[3 * i], red, 1e-6 * red);
            for (std::size_t k = i; k < count; ++k, ++next) {
                double sum = 1;
                for (std::size_t j = 0; j < size; ++j)
                    sum += static_cast<double>(samples[j].solid_angle) * rows[i * k_block_size + j] *
                           rows[k * k_block_size + j];
                EXPECT_NEAR(gram[next], sum, 1e-6 * sum);
            }
        }
    }
}

TEST(Kernels, CombineAndTransformRowsAreTheSameOnAllTargets) {
    std::mt19937 generator(3);
    std::vector<float> matrix(12 * 12);
    for (float& m : matrix) m = static_cast<float>(generator()) * 0x1p-31f - 1;
    std::vector<Rgb> c(12);
    for (Rgb& v : c) v = {static_cast<float>(generator() % 7), static_cast<float>(generator() % 5) - 2, 1};
    for (const std::size_t size : k_sizes) {
        const Directions directions = test::random_directions(Domain::sphere, size, 4);
        const auto rows = rows_of(directions);
        expect_equal_on_all_targets(
            [&] {
                Colours out(size);
                kernels::combine(rows.data(), 12, c, out);
                return flat(out);
            },
            "combine");
        expect_equal_on_all_targets(
            [&] {
                std::vector<float> to(12 * k_block_size), kept;
                kernels::transform_rows(rows.data(), 12, matrix.data(), size, to.data());
                for (std::size_t i = 0; i < 12; ++i)
                    kept.insert(kept.end(), to.begin() + static_cast<std::ptrdiff_t>(i * k_block_size),
                                to.begin() + static_cast<std::ptrdiff_t>(i * k_block_size + size));
                return kept;
            },
            "transform_rows");
    }
}

TEST(Kernels, CombineWritesNothingBeyondItsEnd) {
    for (const std::size_t size : k_sizes) {
        const Directions directions = test::random_directions(Domain::sphere, size, 4);
        const auto rows = rows_of(directions);
        const std::vector<Rgb> c(12, Rgb{1, 1, 1});
        for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
            const test::OnlyTargets only(target);
            // Pass a view of the first entries of a longer array.
            Colours out(size + 40);
            for (std::size_t k = 0; k < 3; ++k) std::fill_n(out.channel(k), size + 40, -7.0f);
            kernels::combine(rows.data(), 12, c, out.view().part(0, size));
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t i = size; i < size + 40; ++i) ASSERT_EQ(out.channel(k)[i], -7) << size;
        }
    }
}

TEST(Kernels, ClampNegativeKeepsNanAndTouchesNothingBeyondItsEnd) {
    for (const std::size_t count : {0u, 1u, 7u, 16u, 37u}) {
        std::vector<float> values(count + 1, -1);
        for (std::size_t i = 0; i < count; ++i) values[i] = i % 3 == 0 ? -2.0f : i % 3 == 1 ? 3.0f : std::nanf("");
        kernels::clamp_negative({values.data(), count});
        for (std::size_t i = 0; i < count; ++i) {
            if (i % 3 == 2)
                EXPECT_TRUE(std::isnan(values[i]));
            else
                EXPECT_EQ(values[i], i % 3 == 0 ? 0 : 3);
        }
        EXPECT_EQ(values[count], -1);
    }
}

TEST(Kernels, SequentialUpdatesAreTheSameOnAllTargets) {
    constexpr std::size_t lanes = 16;
    for (const std::size_t size : k_sizes) {
        const Samples samples = smooth_samples(size);
        const auto rows = rows_of(samples.view().directions());
        std::vector<float> values(lanes * size), gains(lanes * size), steps(size), mean_steps(size);
        for (std::size_t j = 0; j < size; ++j) {
            for (std::size_t i = 0; i < 12; ++i) {
                values[j * lanes + i] = rows[i * k_block_size + j];
                gains[j * lanes + i] = 0.5f * rows[i * k_block_size + j] - 0.1f;
            }
            steps[j] = mean_steps[j] = 1 / static_cast<float>(j + 3);
        }
        for (const int rule : {0, 1, 2})
            for (const float lowest : {0.0f, -1e30f})
                expect_equal_on_all_targets(
                    [&] {
                        std::vector<float> state(5 * lanes, 0.1f);
                        kernels::Sequential s;
                        s.lanes = lanes;
                        for (std::size_t k = 0; k < 3; ++k) s.b[k] = state.data() + k * lanes;
                        s.per_lobe = state.data() + 3 * lanes;
                        s.floor = state.data() + 4 * lanes;
                        s.values = values.data();
                        s.gains = gains.data();
                        s.lowest = lowest;
                        const ColourView radiance = samples.view().radiance();
                        if (rule == 0) kernels::running_average(s, radiance, steps.data());
                        if (rule == 1) kernels::progressive(s, radiance, steps.data(), mean_steps.data());
                        if (rule == 2) kernels::matrix_gain(s, radiance, steps.data());
                        return state;
                    },
                    "sequential rule " + std::to_string(rule));
    }
}

TEST(Targets, EveryBasisIsTheSame) {
    for (const auto& name : basis_names()) {
        const auto basis = make_basis(name).value();
        const LinearBasis* linear = basis->linear();
        if (!linear) continue;
        for (const std::size_t size : k_sizes) {
            const Directions directions = test::random_directions(basis->domain(), size, 6);
            for (std::size_t i = 0; i < basis->size(); ++i)
                expect_equal_on_all_targets(
                    [&] {
                        std::vector<float> rows(basis->size() * k_block_size);
                        linear->values(directions, rows.data());
                        const float* row = rows.data() + i * k_block_size;
                        return std::vector<float>(row, row + size);
                    },
                    name + " function " + std::to_string(i));
            if (basis->size() > 16) break;  // smaller bases test the sizes
        }
    }
}

TEST(Targets, EveryEvaluatorIsTheSame) {
    for (const auto& name : basis_names()) {
        const auto basis = make_basis(name).value();
        std::vector<Rgb> c(basis->size());
        for (std::size_t i = 0; i < c.size(); ++i)
            c[i] = {1, 0.1f * static_cast<float>(i), 2 - static_cast<float>(i % 3)};
        const Directions normals = test::random_directions(Domain::sphere, 300, 6);
        for (const auto& evaluator_name : basis->evaluator_names()) {
            const auto evaluator = basis->evaluator(evaluator_name);
            // Meder and Bruederlin's form is a difference of terms 32.7 times as large as the lobes' integrals, and
            // agrees to 1e-6 of those terms.
            double terms = 0;
            if (evaluator_name == "meder")
                for (const double integral : basis->linear()->integrals()) terms += 32.7 * integral;
            expect_equal_on_all_targets(
                [&] {
                    Colours out(300);
                    irradiance(*evaluator, c, normals, out);
                    return flat(out);
                },
                name + " " + evaluator_name, terms);
        }
    }
}

TEST(Targets, EveryReadingOfGlossIsTheSame) {
    // Members of a family share their code.
    for (const char* name : {"sg12", "sgfit3", "sh1", "sh4"}) {
        const auto basis = make_basis(name).value();
        std::vector<Rgb> c(basis->size());
        for (std::size_t i = 0; i < c.size(); ++i)
            c[i] = {1, 0.1f * static_cast<float>(i), 2 - static_cast<float>(i % 3)};
        const Directions normals = test::random_directions(Domain::sphere, 300, 6);
        const Directions views = test::random_directions(Domain::sphere, 300, 7);
        std::vector<float> alphas(300);
        for (std::size_t i = 0; i < 300; ++i) alphas[i] = 0.1f + 0.003f * static_cast<float>(i);
        for (const auto& reading : specular_names(*basis))
            expect_equal_on_all_targets(
                [&] {
                    Colours out(300);
                    make_specular(reading, basis).value()->reflected(c, {normals, views, alphas}, out);
                    return flat(out);
                },
                std::string(name) + " " + reading);
    }
}

}  // namespace
}  // namespace lobelia
