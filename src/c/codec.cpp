// Codecs and accumulators: encoding and evaluation on the caller's arrays.
#include <algorithm>
#include <array>

#include "c/handles.h"

using namespace lobelia;
using namespace lobelia::c;

namespace {

/// Calls evaluate(directions, out) for blocks of directions, without allocation.
template <class Evaluate>
void for_each_block(const float* directions, std::size_t count, float* out, const Evaluate& evaluate) {
    std::array<float, 3 * k_block_size> from, to;
    for (std::size_t begin = 0; begin < count; begin += k_block_size) {
        const std::size_t size = std::min(k_block_size, count - begin);
        // Fill whole lanes: kernels read them.
        for (std::size_t j = 0; j < round_up_to_lanes(size); ++j)
            for (std::size_t k = 0; k < 3; ++k)
                from[k * k_block_size + j] = j < size ? directions[3 * (begin + j) + k] : 0.0f;
        float *f = from.data(), *t = to.data();
        evaluate(DirectionView{{f, f + k_block_size, f + 2 * k_block_size}, size},
                 MutableColourView{{t, t + k_block_size, t + 2 * k_block_size}, size});
        for (std::size_t j = 0; j < size; ++j)
            for (std::size_t k = 0; k < 3; ++k) out[3 * (begin + j) + k] = to[k * k_block_size + j];
    }
}

/// Checks the arrays of an evaluation.
lob_status check_evaluation(const char* function, const lob_codec* codec, const float* coefficients,
                            std::size_t coefficient_count, const float* directions, const float* out) {
    if (auto status = check_pointers(function, codec, coefficients, directions, out)) return status;
    return check_count(function, lob_codec_size(codec), coefficient_count);
}

}  // namespace

Samples lobelia::c::to_samples(const lob_sample* samples, std::size_t count) {
    Samples result(count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto& [d, L, solid_angle] = samples[i];
        result.set(i, {{d[0], d[1], d[2]}, {L[0], L[1], L[2]}, solid_angle});
    }
    return result;
}

lob_status lob_codec_create(const char* name, lob_codec** out) {
    return guarded([&] {
        if (auto status = check_pointers("lob_codec_create", name, out)) return status;
        auto codec = make_codec(name);
        if (!codec) return fail(LOB_BAD_INPUT, codec.error().message);
        *out = new lob_codec{*std::move(codec)};
        return LOB_OK;
    });
}

const char* lob_codec_name(const lob_codec* codec) { return codec == nullptr ? "" : codec->name.c_str(); }

size_t lob_codec_size(const lob_codec* codec) { return codec == nullptr ? 0 : codec->codec.basis().size(); }

int lob_codec_is_hemispherical(const lob_codec* codec) {
    return codec != nullptr && codec->codec.basis().domain() == Domain::hemisphere ? 1 : 0;
}

void lob_codec_free(lob_codec* codec) { delete codec; }

lob_status lob_encode(const lob_codec* codec, const lob_sample* samples, size_t sample_count, float* coefficients,
                      size_t coefficient_count) {
    return guarded([&] {
        if (auto status = check_pointers("lob_encode", codec, samples, coefficients)) return status;
        if (auto status = check_count("lob_encode", lob_codec_size(codec), coefficient_count)) return status;
        std::ranges::copy(codec->codec.encode(to_samples(samples, sample_count)),
                          colours(coefficients, coefficient_count).begin());
        return LOB_OK;
    });
}

lob_status lob_encode_environment(const lob_codec* codec, const lob_environment* environment, float* coefficients,
                                  size_t coefficient_count) {
    return guarded([&] {
        if (auto status = check_pointers("lob_encode_environment", codec, environment, coefficients)) return status;
        if (auto status = check_count("lob_encode_environment", lob_codec_size(codec), coefficient_count))
            return status;
        // Encoders that learn as they go require texels in an order that is spread over the image.
        const Samples samples = shuffled_texel_samples(environment->image, codec->codec.basis().domain(), 1);
        std::ranges::copy(codec->codec.encode(samples), colours(coefficients, coefficient_count).begin());
        return LOB_OK;
    });
}

lob_status lob_radiance(const lob_codec* codec, const float* coefficients, size_t coefficient_count,
                        const float* directions, size_t count, float* out) {
    return guarded([&] {
        if (auto status = check_evaluation("lob_radiance", codec, coefficients, coefficient_count, directions, out))
            return status;
        if (count == 1) {
            const Vec3 one{directions[0], directions[1], directions[2]};
            colours(out, 1).front() = codec->codec.radiance(colours(coefficients, coefficient_count), one);
            return LOB_OK;
        }
        for_each_block(directions, count, out, [&](DirectionView block, MutableColourView L) {
            codec->codec.radiance(colours(coefficients, coefficient_count), block, L);
        });
        return LOB_OK;
    });
}

lob_status lob_irradiance(const lob_codec* codec, const float* coefficients, size_t coefficient_count,
                          const float* normals, size_t count, float* out) {
    return guarded([&] {
        if (auto status = check_evaluation("lob_irradiance", codec, coefficients, coefficient_count, normals, out))
            return status;
        if (count == 1) {
            const Vec3 one{normals[0], normals[1], normals[2]};
            colours(out, 1).front() = codec->codec.irradiance(colours(coefficients, coefficient_count), one);
            return LOB_OK;
        }
        for_each_block(normals, count, out, [&](DirectionView block, MutableColourView E) {
            codec->codec.irradiance(colours(coefficients, coefficient_count), block, E);
        });
        return LOB_OK;
    });
}

lob_status lob_environment_irradiance(const lob_environment* environment, const float* normals, size_t count,
                                      float* out) {
    return guarded([&] {
        if (auto status = check_pointers("lob_environment_irradiance", environment, normals, out)) return status;
        const Samples samples = texel_samples(environment->image);
        for_each_block(normals, count, out,
                       [&](DirectionView block, MutableColourView E) { irradiance_sum(samples, block, E); });
        return LOB_OK;
    });
}

lob_status lob_accumulator_create(const lob_codec* codec, lob_accumulator** out) {
    return guarded([&] {
        if (auto status = check_pointers("lob_accumulator_create", codec, out)) return status;
        const auto encoder = codec->codec.encoder();
        *out = new lob_accumulator{Accumulator(encoder), encoder, codec->name};
        return LOB_OK;
    });
}

lob_status lob_accumulator_add(lob_accumulator* accumulator, const lob_sample* samples, size_t count) {
    return guarded([&] {
        if (auto status = check_pointers("lob_accumulator_add", accumulator, samples)) return status;
        accumulator->accumulator.add(to_samples(samples, count));
        return LOB_OK;
    });
}

lob_status lob_accumulator_merge(lob_accumulator* accumulator, const lob_accumulator* other) {
    return guarded([&] {
        if (auto status = check_pointers("lob_accumulator_merge", accumulator, other)) return status;
        if (accumulator->codec != other->codec)
            return fail(LOB_MISUSE,
                        "lob_accumulator_merge: codecs differ, " + accumulator->codec + " and " + other->codec);
        accumulator->accumulator.merge(other->accumulator);
        return LOB_OK;
    });
}

lob_status lob_accumulator_solve(const lob_accumulator* accumulator, float* coefficients, size_t coefficient_count) {
    return guarded([&] {
        if (auto status = check_pointers("lob_accumulator_solve", accumulator, coefficients)) return status;
        if (auto status = check_count("lob_accumulator_solve", accumulator->encoder->basis().size(), coefficient_count))
            return status;
        std::ranges::copy(accumulator->accumulator.solve(), colours(coefficients, coefficient_count).begin());
        return LOB_OK;
    });
}

void lob_accumulator_free(lob_accumulator* accumulator) { delete accumulator; }
