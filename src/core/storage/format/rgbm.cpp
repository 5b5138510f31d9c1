// RGBM, many texels at once.
#include "core/storage/format/rgbm.h"

#include "core/storage/format/format_entry.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/storage/format/rgbm.cpp"
#include <hwy/foreach_target.h>  // NOLINT: must precede highway.h
#include <hwy/highway.h>
// NOLINTNEXTLINE: after highway.h
#include "core/storage/format/words-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lobelia::texels::HWY_NAMESPACE {

void EncodeRgbm(const float* const* in, std::size_t count, std::int32_t* out) {
    const D d;
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        const Components c = cut(in, i, 1);
        const V factor = hn::Max(hn::Ceil(hn::Mul(c.largest(), hn::Set(d, 255.0f))), hn::Set(d, 1.0f));
        const V steps = hn::Div(hn::Set(d, 65025.0f), factor);
        hn::StoreU(word_of<8>(c, steps, hn::ConvertTo(I(), factor)), I(), out + i);
    }
}

void DecodeRgbm(const std::uint32_t* in, std::size_t count, float* const* out) {
    const D d;
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        const VU packed = hn::LoadU(U(), in + i);
        const V factor = hn::ConvertTo(d, hn::BitCast(I(), hn::ShiftRight<24>(packed)));
        store_components<8>(packed, hn::Div(factor, hn::Set(d, 65025.0f)), out, i);
    }
}

}  // namespace lobelia::texels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobelia::texels {

HWY_EXPORT(EncodeRgbm);
HWY_EXPORT(DecodeRgbm);

namespace {

void encode_rgbm(const float* const* in, std::size_t count, std::byte* out) {
    HWY_DYNAMIC_DISPATCH(EncodeRgbm)(in, count, reinterpret_cast<std::int32_t*>(out));
}
void decode_rgbm(const std::byte* bytes, std::size_t count, float* const* out) {
    HWY_DYNAMIC_DISPATCH(DecodeRgbm)(reinterpret_cast<const std::uint32_t*>(bytes), count, out);
}

const ShaderFunction& shader_decode_rgbm() {
    static const ShaderFunction k_function = {"decode_rgbm8",
                                              "/// Returns the colour of an RGBM texel.\n"
                                              "vec3 decode_rgbm8(vec4 texel) {\n"
                                              "    return texel.w * vec3(texel.x, texel.y, texel.z);\n"
                                              "}\n"};
    return k_function;
}

}  // namespace

constinit const FormatEntry rgbm8 = {.info = {"rgbm8", 3, 1, 4, 37, 0, 1},
                                     .encode = encode_rgbm,
                                     .decode = decode_rgbm,
                                     .scaling = Scaling::always,
                                     .shader_decode = shader_decode_rgbm};

}  // namespace lobelia::texels
#endif
