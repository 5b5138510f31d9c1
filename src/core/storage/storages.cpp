// THE list of storages.
#include <array>

#include "core/storage/layouts.h"

namespace lobelia {
namespace {

using Of = ErrorBound::Of;
using Suits = Storage::Suits;

// Layouts with their formats, as the list takes them.
template <const layouts::Widths& widths>
TextureLayout tight_in(const CoefficientTraits& traits) {
    return layouts::tight(traits, widths);
}
template <PixelFormat format>
TextureLayout one_each(const CoefficientTraits& traits) {
    return layouts::one_each(traits, format);
}
template <PixelFormat lead>
TextureLayout ratios_of_8_bits(const CoefficientTraits& traits) {
    return layouts::ratios_of_8_bits(traits, lead);
}
template <PixelFormat lead>
TextureLayout ratios_of_10_bits(const CoefficientTraits& traits) {
    return layouts::ratios_of_10_bits(traits, lead);
}

constexpr std::array k_storages = {
    Storage{"float32", "floats of 32 bits", Suits::any, {}, tight_in<layouts::k_float32>},
    Storage{"float16",
            "floats of 16 bits",
            Suits::any,
            {.relative = 0x1p-11, .absolute = 0x1p-25},
            tight_in<layouts::k_float16>},
    // Each of luma and both chromas is off by half an ulp; their magnitudes add up to twice the largest channel's at
    // most. A mean of four is 3/4 of their difference from any of them; red and blue take 3/2 of it from both chromas.
    Storage{"ycocg",
            "luma of 16 bits, chroma of 16 bits for 2 x 2 texels",
            Suits::colours,
            {.relative = 0x1p-10 + 1e-6, .of = Of::together, .absolute = 3 * 0x1p-25, .spread = 1.125, .shared = 2},
            layouts::luma_and_chroma},
    Storage{"rgb9e5",
            "colours of 9 bits with a common exponent of 5",
            Suits::non_negative,
            {.relative = 0x1p-9, .of = Of::together, .absolute = 0x1p-25},
            one_each<PixelFormat::rgb9e5>},
    Storage{"rgbe",
            "colours of 8 bits with a common exponent of 8",
            Suits::non_negative,
            {.relative = 0x1p-8, .of = Of::together, .absolute = 0x1p-100},
            one_each<PixelFormat::rgbe8>},
    Storage{"rgbm",
            "colours of 8 bits times a factor of 8",
            Suits::non_negative,
            {.relative = 0.5 / 255 + 1e-6, .of = Of::together, .of_texture = 1.0 / 65025},
            one_each<PixelFormat::rgbm8>},
    Storage{"logluv",
            "logarithm of luminance in 16 bits, chromaticity in 8 and 8",
            Suits::non_negative,
            {.relative = 0.0213, .of = Of::together, .absolute = 0x1p-59},
            one_each<PixelFormat::logluv32>},
    Storage{"bc6h",
            "BC6H blocks without a sign",
            Suits::non_negative,
            {.relative = 0x1p-10, .absolute = 0x1p-22, .spread = 1, .shared = 4},
            one_each<PixelFormat::bc6h_unsigned>},
    Storage{"bc6h-signed",
            "BC6H blocks with a sign",
            Suits::any,
            {.relative = 0x1p-10, .absolute = 0x1p-22, .spread = 1, .shared = 4},
            one_each<PixelFormat::bc6h_signed>},
    // Ratios go from -1 to 1 times their bound in 255 or 1023 steps. They are ratios to the lead as it is read back;
    // where that is too small, the largest of them lack what the lead lacks.
    Storage{"ratio8",
            "the leading coefficient as rgb9e5, the others as ratios to it of 8 bits",
            Suits::bounded_by_lead,
            {.relative = (1 + 0x1p-9) / 255 + 1e-6, .of = Of::lead, .absolute = 0x1p-24},
            ratios_of_8_bits<PixelFormat::rgb9e5>},
    Storage{"ratio10",
            "the leading coefficient as rgb9e5, the others as ratios to it of 10 bits",
            Suits::bounded_by_lead,
            {.relative = 0x1p-9 + 1e-6, .of = Of::lead, .absolute = 0x1p-24},
            ratios_of_10_bits<PixelFormat::rgb9e5>},
    Storage{"bc6h-ratio8",
            "the leading coefficient as BC6H, the others as ratios to it of 8 bits",
            Suits::bounded_by_lead,
            {.relative = (1 + 0x1p-10) / 255 + 1e-6, .of = Of::lead, .absolute = 0x1p-22, .spread = 1, .shared = 4},
            ratios_of_8_bits<PixelFormat::bc6h_unsigned>},
};

}  // namespace

std::span<const Storage> storages() { return k_storages; }

std::vector<const Storage*> default_storages(const CoefficientTraits& traits) {
    std::vector<const Storage*> chosen;
    for (const std::string_view name : {"float16", "ratio8"})
        if (const Storage* storage = find_storage(name).value(); suits(*storage, traits)) chosen.push_back(storage);
    return chosen;
}

}  // namespace lobelia
