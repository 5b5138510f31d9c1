// LogLuv, many texels at once. A luminance so near to the edge of a step that logarithms differ by rounding may fall on
// either side of it.
#include "core/storage/format/logluv.h"

#include "core/math/shader_pattern.h"
#include "core/math/shader_text.h"
#include "core/storage/format/format_entry.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/storage/format/logluv.cpp"
#include <hwy/foreach_target.h>  // NOLINT: must precede highway.h
#include <hwy/highway.h>
// NOLINTNEXTLINE: after highway.h
#include <hwy/contrib/math/math-inl.h>

// NOLINTNEXTLINE: after highway.h
#include "core/storage/format/words-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lobelia::texels::HWY_NAMESPACE {

HWY_INLINE V sum_of(V x, float a, V y, float b, V z, float c) {
    const D d;
    return hn::MulAdd(x, hn::Set(d, a), hn::MulAdd(y, hn::Set(d, b), hn::Mul(z, hn::Set(d, c))));
}

void EncodeLogluv(const float* const* in, std::size_t count, std::int32_t* out) {
    const D d;
    const I di;
    const auto component = [&](std::size_t k, std::size_t i) { return hn::Max(hn::LoadU(d, in[k] + i), hn::Zero(d)); };
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        const V r = component(0, i), g = component(1, i), b = component(2, i);
        const V X = sum_of(r, 0.41239080f, g, 0.35758434f, b, 0.18048079f);
        const V Y = sum_of(r, 0.21263901f, g, 0.71516868f, b, 0.07219232f);
        const V Z = sum_of(r, 0.01933082f, g, 0.11919478f, b, 0.95053215f);
        const V steps = hn::Div(hn::Set(d, k_chroma_steps), sum_of(X, 1, Y, 15, Z, 3));
        const VI u = hn::ConvertTo(di, hn::Mul(hn::Mul(X, hn::Set(d, 4.0f)), steps));
        const VI v = hn::ConvertTo(di, hn::Mul(hn::Mul(Y, hn::Set(d, 9.0f)), steps));
        const V within = hn::Min(hn::Max(Y, hn::Set(d, k_least_luminance)), hn::Set(d, k_largest_luminance));
        const VI log =
            hn::ConvertTo(di, hn::Mul(hn::Sub(hn::Log2(d, within), hn::Set(d, k_least_log)), hn::Set(d, k_log_steps)));
        const VI packed = hn::Or(hn::ShiftLeft<16>(log), hn::Or(hn::ShiftLeft<8>(u), v));
        const auto lit = hn::RebindMask(di, hn::Ge(Y, hn::Set(d, k_least_luminance)));
        hn::StoreU(hn::IfThenElseZero(lit, packed), di, out + i);
    }
}

void DecodeLogluv(const std::int32_t* in, std::size_t count, float* const* out) {
    const D d;
    const I di;
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        const VI packed = hn::LoadU(di, in + i);
        const VI log = hn::And(hn::ShiftRight<16>(packed), hn::Set(di, 0x7fff));
        // Y = 2^whole times e^(the rest), the rest below ln 2.
        const V rest = hn::Add(hn::ConvertTo(d, hn::And(log, hn::Set(di, 255))), hn::Set(d, 0.5f));
        const V fraction = hn::Exp(d, hn::Mul(rest, hn::Set(d, 0.693147181f / k_log_steps)));
        const V power = power_of_two(hn::Sub(hn::ShiftRight<8>(log), hn::Set(di, 64)));
        const V Y = hn::IfThenElseZero(hn::RebindMask(d, hn::Gt(log, hn::Zero(di))), hn::Mul(fraction, power));

        const auto chroma = [&](VI word) {
            const V step = hn::ConvertTo(d, hn::And(word, hn::Set(di, 255)));
            return hn::Mul(hn::Add(step, hn::Set(d, 0.5f)), hn::Set(d, 1 / k_chroma_steps));
        };
        const V u = chroma(hn::ShiftRight<8>(packed)), v = chroma(packed);
        const V scale = hn::Div(Y, hn::Mul(v, hn::Set(d, 4.0f)));
        const V X = hn::Mul(hn::Mul(u, hn::Set(d, 9.0f)), scale);
        const V Z =
            hn::Mul(hn::Sub(hn::Set(d, 12.0f), hn::MulAdd(u, hn::Set(d, 3.0f), hn::Mul(v, hn::Set(d, 20.0f)))), scale);
        const auto store = [&](V value, float* to) { hn::StoreU(hn::Max(value, hn::Zero(d)), d, to); };
        store(sum_of(X, 3.2409699f, Y, -1.5373832f, Z, -0.49861076f), out[0] + i);
        store(sum_of(X, -0.96924364f, Y, 1.8759675f, Z, 0.041555057f), out[1] + i);
        store(sum_of(X, 0.055630080f, Y, -0.20397696f, Z, 1.0569715f), out[2] + i);
    }
}

}  // namespace lobelia::texels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobelia::texels {

HWY_EXPORT(EncodeLogluv);
HWY_EXPORT(DecodeLogluv);

namespace {

void encode_logluv(const float* const* in, std::size_t count, std::byte* out) {
    HWY_DYNAMIC_DISPATCH(EncodeLogluv)(in, count, reinterpret_cast<std::int32_t*>(out));
}
void decode_logluv(const std::byte* bytes, std::size_t count, float* const* out) {
    HWY_DYNAMIC_DISPATCH(DecodeLogluv)(reinterpret_cast<const std::int32_t*>(bytes), count, out);
}

/// X = 9 u Y / 4 v and Z = (12 - 3 u - 20 v) Y / 4 v: red, green and blue are linear in u, v and 1, times Y / v. Here u
/// and v are in steps, of which 255 are 1 in the texture.
ShaderFunction logluv_function() {
    const Rgb x = rgb_from({1, 0, 0}), y = rgb_from({0, 1, 0}), z = rgb_from({0, 0, 1});
    const Rgb by_u = x * 2.25f - z * 0.75f, by_v = y - z * 5.0f, constant = z * (3 * k_chroma_steps);
    const auto literal = [](Rgb c) { return shader_text::literal(Vec3{c.r, c.g, c.b}); };
    return {"decode_logluv32",
            shader_text::filled(
                "/// Returns the colour of a LogLuv texel, its bytes over 255: 256 steps for each power of two of the\n"
                "/// luminance, 410 for 1 of the chromaticities u' and v' (Ward Larson 1998).\n"
                "vec3 decode_logluv32(vec4 texel) {\n"
                "    float log_steps = 256.0 * floor(255.0 * texel.w + 0.5) + floor(255.0 * texel.z + 0.5);\n"
                "    float luminance = choose(log_steps > 0.0, exp2((log_steps + 0.5) / 256.0 - 64.0), 0.0);\n"
                "    float u = 255.0 * texel.y + 0.5;\n"
                "    float v = 255.0 * texel.x + 0.5;\n"
                "    vec3 colour = $0 * u + $1 * v + $2;\n"
                "    return max(colour * (luminance / v), vec3(0.0));\n"
                "}\n",
                {literal(by_u), literal(by_v), literal(constant)})};
}
const ShaderFunction& shader_decode_logluv() {
    static const ShaderFunction k_function = logluv_function();
    return k_function;
}

}  // namespace

constinit const FormatEntry logluv32 = {.info = {"logluv32", 3, 1, 4, 37, 0, 0x1p60},
                                        .encode = encode_logluv,
                                        .decode = decode_logluv,
                                        .shader_decode = shader_decode_logluv};

}  // namespace lobelia::texels
#endif
