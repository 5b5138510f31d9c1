// Counts heap allocations: evaluation and the adding of samples must not allocate once a thread has its working memory.
// A separate program, because it replaces operator new.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <memory>
#include <new>

#include "lobelia/codec.h"
#include "lobelia/environment.h"
#include "lobelia/evaluate.h"
#include "lobelia/sampling.h"
#include "lobelia/sky.h"
#include "lobelia/storage.h"

namespace {
std::atomic<std::size_t> allocations = 0;

void* counted(std::size_t size, std::size_t alignment) {
    ++allocations;
    const std::size_t whole = (size + alignment - 1) / alignment * alignment;
    void* const memory = std::aligned_alloc(alignment, whole > 0 ? whole : alignment);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}
/// Not inlined, because compilers would warn about freeing memory of operator new.
__attribute__((noinline)) void release(void* memory) { std::free(memory); }
}  // namespace

void* operator new(std::size_t size) { return counted(size, alignof(std::max_align_t)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
    return counted(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }

namespace lobelia {
namespace {

/// Returns the allocations of the second call of `call`: the first may allocate the thread's working memory.
template <class Call>
std::size_t allocations_of(const Call& call) {
    call();
    const std::size_t before = allocations;
    call();
    return allocations - before;
}

std::vector<Rgb> coefficients(const std::shared_ptr<const Basis>& basis) {
    Accumulator accumulator(make_encoder(encoder_names(*basis).front(), basis).value());
    accumulator.add(
        directed_samples(sky({64, 32}), uniform_directions(basis->domain(), Sequence::sobol, 200, 1), basis->domain()));
    return accumulator.solve();
}

/// Evaluators that search or build series for each set of coefficients; not meant for run-time evaluation.
bool searches(const std::string& basis, const std::string& evaluator) {
    return evaluator == "dering" || basis.starts_with("sgfit");
}

TEST(Allocations, AreCounted) {
    std::unique_ptr<int> kept;
    EXPECT_EQ(allocations_of([&] { kept = std::make_unique<int>(1); }), 1u);
    EXPECT_EQ(allocations_of([] { Directions(5); }), 1u);
}

TEST(Allocations, EvaluationHasNone) {
    const Vec3 w = normalize(Vec3{0.3f, 0.4f, 0.5f});
    for (const auto& name : basis_names()) {
        const auto basis = make_basis(name).value();
        const auto c = coefficients(basis);
        const Directions directions = uniform_directions(basis->domain(), Sequence::sobol, 300, 2);
        Colours out(directions.size());
        volatile float sink = 0;
        if (!name.starts_with("sgfit")) {
            EXPECT_EQ(allocations_of([&] { sink = basis->radiance_at(c, w).r; }), 0u) << name;
            EXPECT_EQ(allocations_of([&] { basis->radiance(c, directions, out); }), 0u) << name;
        }
        for (const auto& evaluator_name : basis->evaluator_names()) {
            if (searches(name, evaluator_name)) continue;
            const auto evaluator = make_evaluator(evaluator_name, *basis).value();
            EXPECT_EQ(allocations_of([&] { sink = irradiance(*evaluator, c, w).r; }), 0u)
                << name << " " << evaluator_name;
            EXPECT_EQ(allocations_of([&] { irradiance(*evaluator, c, directions, out); }), 0u)
                << name << " " << evaluator_name;
        }
    }
}

TEST(Allocations, AddingSamplesHasNone) {
    for (const char* name : {"sg12", "sh2", "oct8", "ambient-cube"}) {
        const auto basis = make_basis(name).value();
        const Samples samples = directed_samples(
            sky({64, 32}), uniform_directions(basis->domain(), Sequence::sobol, 300, 2), basis->domain());
        for (const auto& encoder_name : encoder_names(*basis)) {
            const auto encoder = make_encoder(encoder_name, basis).value();
            std::vector<float> state(encoder->state_size());
            EXPECT_EQ(allocations_of([&] { encoder->add(state, samples); }), 0u) << name << " " << encoder_name;
            EXPECT_EQ(allocations_of([&] { encoder->add(state, samples.view().part(0, 5)); }), 0u)
                << name << " " << encoder_name;
        }
    }
}

TEST(Allocations, SamplingTexturesHasNone) {
    const CoefficientTraits traits{4, true, true, std::vector<float>(4, 1.0f)};
    const std::vector<float> plane(64, 0.5f);
    const CoefficientPlanes planes(8, 8, std::vector<const float*>(12, plane.data()));
    for (const Storage& storage : storages()) {
        const auto packed = pack(storage.layout(traits), planes);
        const auto sampler = TextureSampler::make(storage.layout(traits), packed).value();
        std::vector<Rgb> c(4);
        EXPECT_EQ(allocations_of([&] { sampler.sample({0.3f, 0.7f}, c); }), 0u) << storage.name;
    }
}

}  // namespace
}  // namespace lobelia
