// Measures irradiance by the path tracer, with its standard error, from independent keys with samples of their own.
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

/// E at a surface point with `normal` (for a probe: mean radiance times pi). The point is moved off the surface first.
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

/// Fails if an estimate differs from the expected value by more than `errors` standard errors plus rounding.
inline void expect_near(const Estimate& found, double truth, double errors, const std::string& what = {}) {
    EXPECT_NEAR(found.mean(), truth, errors * found.standard_error() + 2e-5 * std::abs(truth)) << what;
}

}  // namespace lobelia::test
