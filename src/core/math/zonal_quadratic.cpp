// Zonal quadratics, vectorised over directions.
#include "core/math/zonal_quadratic.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/math/zonal_quadratic.cpp"
#include <hwy/foreach_target.h>  // NOLINT: must precede highway.h
#include <hwy/highway.h>
// NOLINTNEXTLINE: after highway.h
#include "core/math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lobelia::HWY_NAMESPACE {

void ZonalQuadraticRow(const ZonalQuadratic& f, DirectionView directions, float* row) {
    const D d;
    const V constant = hn::Set(d, f.constant - f.quadratic / 2), quadratic = hn::Set(d, 1.5f * f.quadratic);
    for (std::size_t j = 0; j < directions.size; j += hn::Lanes(d)) {
        const Lanes3 w = load(d, directions, j);
        const V t = dot(d, f.axis, w);
        const V even = hn::MulAdd(quadratic, hn::Mul(t, t), constant);
        store(d, hn::Add(even, dot(d, f.linear, w)), row, j, directions.size);
    }
}

}  // namespace lobelia::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobelia {

HWY_EXPORT(ZonalQuadraticRow);

void evaluate(const std::array<ZonalQuadratic, 3>& functions, DirectionView directions, MutableColourView out) {
    check_equal("colours for the directions", out.size, directions.size);
    for (std::size_t k = 0; k < 3; ++k)
        HWY_DYNAMIC_DISPATCH(ZonalQuadraticRow)(functions[k], directions, out.channel(k));
}

}  // namespace lobelia
#endif
