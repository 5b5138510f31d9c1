// RGBE, many texels at once.
#include "core/storage/format/rgbe.h"

#include "core/storage/format/format_entry.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/storage/format/rgbe.cpp"
#include <hwy/foreach_target.h>  // NOLINT: must precede highway.h
#include <hwy/highway.h>
// NOLINTNEXTLINE: after highway.h
#include "core/storage/format/words-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lobelia::texels::HWY_NAMESPACE {

void EncodeRgbe(const float* const* in, std::size_t count, std::int32_t* out) {
    const I di;
    for (std::size_t i = 0; i < count; i += hn::Lanes(di)) {
        const Components c = cut(in, i, k_largest_rgbe);
        const V largest = c.largest();
        const VI exponent = hn::Add(hn::ShiftRight<23>(hn::BitCast(di, largest)), hn::Set(di, 2));
        const V steps = power_of_two(hn::Sub(hn::Set(di, 136), exponent));
        const auto lit = hn::RebindMask(di, hn::Ge(largest, hn::Set(D(), k_least_rgbe)));
        hn::StoreU(hn::IfThenElseZero(lit, word_of<8>(c, steps, exponent)), di, out + i);
    }
}

void DecodeRgbe(const std::uint32_t* in, std::size_t count, float* const* out) {
    const I di;
    for (std::size_t i = 0; i < count; i += hn::Lanes(di)) {
        const VU packed = hn::LoadU(U(), in + i);
        const VI exponent = hn::BitCast(di, hn::ShiftRight<24>(packed)), half = hn::ShiftRight<1>(exponent);
        const auto root = [&](VI e) { return power_of_two(hn::Sub(e, hn::Set(di, 68))); };
        const auto lit = hn::RebindMask(D(), hn::Gt(exponent, hn::Zero(di)));
        const V step = hn::IfThenElseZero(lit, hn::Mul(root(half), root(hn::Sub(exponent, half))));
        store_components<8>(packed, step, out, i);
    }
}

}  // namespace lobelia::texels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobelia::texels {

HWY_EXPORT(EncodeRgbe);
HWY_EXPORT(DecodeRgbe);

namespace {

void encode_rgbe(const float* const* in, std::size_t count, std::byte* out) {
    HWY_DYNAMIC_DISPATCH(EncodeRgbe)(in, count, reinterpret_cast<std::int32_t*>(out));
}
void decode_rgbe(const std::byte* bytes, std::size_t count, float* const* out) {
    HWY_DYNAMIC_DISPATCH(DecodeRgbe)(reinterpret_cast<const std::uint32_t*>(bytes), count, out);
}

const ShaderFunction& shader_decode_rgbe() {
    static const ShaderFunction k_function = {
        "decode_rgbe8",
        "/// Returns the colour of an RGBE texel, its bytes over 255: mantissas times 2^(exponent - 136); black if "
        "the\n"
        "/// exponent is 0 (Ward 1991).\n"
        "vec3 decode_rgbe8(vec4 texel) {\n"
        "    float exponent = floor(255.0 * texel.w + 0.5);\n"
        "    float scale = choose(exponent > 0.0, 255.0 * exp2(exponent - 136.0), 0.0);\n"
        "    return scale * vec3(texel.x, texel.y, texel.z);\n"
        "}\n"};
    return k_function;
}

}  // namespace

constinit const FormatEntry rgbe8 = {.info = {"rgbe8", 3, 1, 4, 37, 0, k_largest_rgbe},
                                     .encode = encode_rgbe,
                                     .decode = decode_rgbe,
                                     .shader_decode = shader_decode_rgbe};

}  // namespace lobelia::texels
#endif
