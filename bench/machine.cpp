// The machine's own limits, at the vector width that the kernels use too.
#include "bench/machine.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/machine.cpp"
#include <hwy/foreach_target.h>  // NOLINT: must precede highway.h
#include <hwy/highway.h>
// NOLINTNEXTLINE: after highway.h
#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
namespace lobelia::bench::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void ExpAll(const float* x, float* y, std::size_t count) {
    const hn::CappedTag<float, 16> d;
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) hn::StoreU(hn::Exp(d, hn::LoadU(d, x + i)), d, y + i);
}

float FmaChain(std::size_t count) {
    const hn::CappedTag<float, 16> d;
    constexpr std::size_t chains = 10;
    auto factor = hn::Set(d, 0.999f), term = hn::Set(d, 0.001f);
    hn::Vec<decltype(d)> sum[chains];
    for (std::size_t k = 0; k < chains; ++k) sum[k] = hn::Set(d, static_cast<float>(k));
    for (std::size_t i = 0; i < count; i += chains * hn::Lanes(d))
        for (std::size_t k = 0; k < chains; ++k) sum[k] = hn::MulAdd(sum[k], factor, term);
    for (std::size_t k = 1; k < chains; ++k) sum[0] = hn::Add(sum[0], sum[k]);
    return hn::GetLane(hn::SumOfLanes(d, sum[0]));
}

const char* TargetName() { return hwy::TargetName(HWY_TARGET); }

}  // namespace lobelia::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobelia::bench {

HWY_EXPORT(ExpAll);
HWY_EXPORT(FmaChain);
HWY_EXPORT(TargetName);

void exp_all(const float* x, float* y, std::size_t count) { HWY_DYNAMIC_DISPATCH(ExpAll)(x, y, count); }
float fma_chain(std::size_t count) { return HWY_DYNAMIC_DISPATCH(FmaChain)(count); }
const char* target_name() { return HWY_DYNAMIC_DISPATCH(TargetName)(); }

}  // namespace lobelia::bench
#endif
