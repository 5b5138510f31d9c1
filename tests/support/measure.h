// Irradiance as the path tracer gives it, with its standard error: independent keys, each with samples of its own.
#pragma once

#include <gtest/gtest.h>

#include "bake/gather/gather.h"
#include "small_scenes.h"

namespace lobelia::test {

struct Measured {
    std::array<Estimate, 3> channels;
    std::uint32_t back_faces = 0;
};

struct MeasureOptions {
    Domain domain = Domain::hemisphere;
    DirectionChoice directions = DirectionChoice::uniform;
    std::uint32_t keys = 64, samples = 256;
};

/// E at a point of a surface with `normal` (or mean radiance times pi of a probe), the point being lifted first.
inline Measured measure(const PathTracer& tracer, Vec3 on_surface, Vec3 normal, const MeasureOptions& options = {}) {
    const Vec3 position = on_surface + normal * tracer.lift(on_surface);
    std::vector<Receiver> receivers(options.keys);
    for (std::uint32_t key = 0; key < options.keys; ++key) {
        receivers[key].positions[0] = position;
        receivers[key].position_count = 1;
        receivers[key].normal = normal;
        receivers[key].domain = options.domain;
        receivers[key].key = key;
    }
    GatherBuffer buffer;
    const auto scratch = tracer.make_scratch();
    gather(tracer, receivers, {0, options.samples}, {options.directions}, buffer, *scratch);
    Measured result;
    for (std::size_t r = 0; r < receivers.size(); ++r) {
        const Gathered& g = buffer.gathered(r);
        result.channels[0].add(static_cast<double>(g.irradiance.r));
        result.channels[1].add(static_cast<double>(g.irradiance.g));
        result.channels[2].add(static_cast<double>(g.irradiance.b));
        result.back_faces += g.back_faces;
    }
    return result;
}

/// Fails where an estimate is more than `errors` standard errors from the truth, beyond what rounding explains.
inline void expect_near(const Estimate& found, double truth, double errors, const std::string& what = {}) {
    EXPECT_NEAR(found.mean(), truth, errors * found.standard_error() + 2e-5 * std::abs(truth)) << what;
}

}  // namespace lobelia::test
