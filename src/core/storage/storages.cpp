// THE list of storages, and what follows from a storage's data.
#include <algorithm>
#include <array>
#include <cmath>

#include "lobelia/codec.h"
#include "lobelia/storage.h"

namespace lobelia {
namespace {

using Of = ErrorBound::Of;
using Suits = Storage::Suits;
using Form = StoredChannel::Form;
using Texture = TextureLayout::Texture;

/// Formats of one, two and four channels of the same numbers.
struct Widths {
    PixelFormat one, two, four;
};
constexpr Widths k_float32{PixelFormat::r32f, PixelFormat::rg32f, PixelFormat::rgba32f};
constexpr Widths k_float16{PixelFormat::r16f, PixelFormat::rg16f, PixelFormat::rgba16f};
constexpr Widths k_unorm8{PixelFormat::r8, PixelFormat::rg8, PixelFormat::rgba8};

/// Appends textures that hold the channels four by four, and the last of them in as narrow a format as may be.
void append_tight(TextureLayout& layout, const std::string& name, const std::vector<StoredChannel>& channels,
                  const Widths& widths, std::size_t subsampling = 1) {
    for (std::size_t i = 0; i < channels.size(); i += 4) {
        const std::size_t count = std::min<std::size_t>(4, channels.size() - i);
        const PixelFormat format = count == 1 ? widths.one : count == 2 ? widths.two : widths.four;
        const auto begin = channels.begin() + static_cast<std::ptrdiff_t>(i);
        layout.textures.push_back({name + std::to_string(i / 4), format,
                                   std::vector(begin, begin + static_cast<std::ptrdiff_t>(count)), subsampling});
    }
}

std::vector<StoredChannel> rgb_of(std::size_t coefficient) {
    return {{coefficient, Component::r}, {coefficient, Component::g}, {coefficient, Component::b}};
}

/// Every coefficient's channels as they are, one after the other.
template <const Widths& widths>
TextureLayout tight(const CoefficientTraits& traits) {
    TextureLayout layout{traits.count, {}};
    std::vector<StoredChannel> channels;
    for (std::size_t i = 0; i < traits.count; ++i)
        for (const StoredChannel& channel : rgb_of(i)) channels.push_back(channel);
    append_tight(layout, "v", channels, widths);
    return layout;
}

/// A colour texture for each coefficient.
template <PixelFormat format>
TextureLayout one_each(const CoefficientTraits& traits) {
    TextureLayout layout{traits.count, {}};
    for (std::size_t i = 0; i < traits.count; ++i)
        layout.textures.push_back({"c" + std::to_string(i), format, rgb_of(i)});
    return layout;
}

/// Luma in full, chroma for two by two texels, as halves.
TextureLayout luma_and_chroma(const CoefficientTraits& traits) {
    TextureLayout layout{traits.count, {}};
    std::vector<StoredChannel> luma, chroma;
    for (std::size_t i = 0; i < traits.count; ++i) {
        luma.push_back({i, Component::luma});
        chroma.push_back({i, Component::chroma_orange});
        chroma.push_back({i, Component::chroma_green});
    }
    append_tight(layout, "luma", luma, k_float16);
    append_tight(layout, "chroma", chroma, k_float16, 2);
    return layout;
}

/// The ratios of a coefficient to the leading one, which are within its bound, as numbers in [0, 1].
std::vector<StoredChannel> ratios_of(std::size_t coefficient, const CoefficientTraits& traits) {
    auto channels = rgb_of(coefficient);
    for (StoredChannel& channel : channels) {
        channel.form = Form::ratio;
        channel.scale = 0.5f / traits.lead_bounds[coefficient];
        channel.offset = 0.5f;
    }
    return channels;
}

/// The leading coefficient as a colour, the others as bytes that are ratios to it.
template <PixelFormat lead>
TextureLayout ratios_of_8_bits(const CoefficientTraits& traits) {
    TextureLayout layout{traits.count, {{"c0", lead, rgb_of(0)}}};
    std::vector<StoredChannel> channels;
    for (std::size_t i = 1; i < traits.count; ++i)
        for (const StoredChannel& channel : ratios_of(i, traits)) channels.push_back(channel);
    append_tight(layout, "ratio", channels, k_unorm8);
    return layout;
}
template <PixelFormat lead>
TextureLayout ratios_of_10_bits(const CoefficientTraits& traits) {
    TextureLayout layout{traits.count, {{"c0", lead, rgb_of(0)}}};
    for (std::size_t i = 1; i < traits.count; ++i)
        layout.textures.push_back({"ratio" + std::to_string(i), PixelFormat::rgb10a2, ratios_of(i, traits)});
    return layout;
}

constexpr std::array k_storages = {
    Storage{"float32", "floats of 32 bits", Suits::any, {}, tight<k_float32>},
    Storage{"float16", "floats of 16 bits", Suits::any, {.relative = 0x1p-11, .absolute = 0x1p-25}, tight<k_float16>},
    // Each of luma and both chromas is off by half an ulp; their magnitudes add up to twice the largest channel's at
    // most. A mean of four is 3/4 of their difference from any of them; red and blue take 3/2 of it from both chromas.
    Storage{"ycocg",
            "luma of 16 bits, chroma of 16 bits for 2 x 2 texels",
            Suits::colours,
            {.relative = 0x1p-10 + 1e-6, .of = Of::together, .absolute = 3 * 0x1p-25, .spread = 1.125, .shared = 2},
            luma_and_chroma},
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

/// Why not, and what would do.
Error unsuitable(const Storage& storage, const CoefficientTraits& traits) {
    constexpr std::array<std::string_view, 4> wants = {"any", "coefficients that are never negative",
                                                       "coefficients that are colours",
                                                       "coefficients that the first of them bounds"};
    std::string suitable;
    for (const Storage& other : k_storages)
        if (suits(other, traits)) suitable += (suitable.empty() ? "" : ", ") + std::string(other.name);
    return Error{"storage \"" + std::string(storage.name) + "\" wants " +
                 std::string(wants[static_cast<std::size_t>(storage.suits)]) + "; what suits here: " + suitable};
}

/// Largest magnitude of a texel's three channels of a coefficient.
float largest_channel(const CoefficientPlanes& c, std::size_t coefficient, std::size_t texel) {
    float largest = 0;
    for (std::size_t k = 0; k < 3; ++k) largest = std::max(largest, std::abs(c.planes[3 * coefficient + k][texel]));
    return largest;
}

/// Largest difference, in any channel of a coefficient, within the square of texels that holds (x, y).
float spread_at(const CoefficientPlanes& c, std::size_t coefficient, std::size_t x, std::size_t y, std::size_t side) {
    const std::size_t left = x / side * side, top = y / side * side;
    float spread = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const float* plane = c.planes[3 * coefficient + k];
        float low = HUGE_VALF, high = -HUGE_VALF;
        for (std::size_t v = top; v < std::min(top + side, c.height); ++v)
            for (std::size_t u = left; u < std::min(left + side, c.width); ++u) {
                low = std::min(low, plane[v * c.width + u]);
                high = std::max(high, plane[v * c.width + u]);
            }
        spread = std::max(spread, high - low);
    }
    return spread;
}

/// Whether the storage can hold a texel's value, or has to cut it.
bool is_within(const Storage& storage, const CoefficientTraits& traits, const CoefficientPlanes& c, std::size_t plane,
               std::size_t texel) {
    const float value = c.planes[plane][texel];
    if (storage.suits == Suits::non_negative) return value >= 0;
    if (storage.suits != Suits::bounded_by_lead) return true;
    const float lead = c.planes[plane % 3][texel];
    return lead >= 0 && std::abs(value) <= traits.lead_bounds[plane / 3] * lead * (1 + 1e-6f);
}

/// The bound at one texel of one plane. `scale`: what its values are divided by before they are stored.
double bound_at(const ErrorBound& bound, const CoefficientTraits& traits, const CoefficientPlanes& c, std::size_t plane,
                std::size_t texel) {
    const std::size_t i = plane / 3, of = bound.of == Of::lead ? 0 : i;
    const double factor = bound.of == Of::lead ? traits.lead_bounds[i] : 1;
    const double magnitude = bound.of == Of::value ? std::abs(c.planes[plane][texel]) : largest_channel(c, of, texel);
    double allowed = bound.relative * magnitude + bound.absolute;
    if (bound.spread > 0) allowed += bound.spread * spread_at(c, of, texel % c.width, texel / c.width, bound.shared);
    return allowed * factor;
}

}  // namespace

std::span<const Storage> storages() { return k_storages; }

CoefficientTraits coefficient_traits(const Encoder& encoder) {
    const Basis& basis = encoder.basis();
    return {basis.size(), encoder.is_non_negative(), basis.has_colours(), basis.lead_bounds()};
}

CoefficientTraits coefficient_traits(const std::shared_ptr<const Basis>& basis) {
    CoefficientTraits traits{basis->size(), false, basis->has_colours(), basis->lead_bounds()};
    if (basis->linear() == nullptr || !basis->linear()->is_non_negative()) return traits;
    for (const auto& encoder : encoder_names(*basis))
        traits.non_negative = traits.non_negative || make_encoder(encoder, basis).value()->is_non_negative();
    return traits;
}

bool suits(const Storage& storage, const CoefficientTraits& traits) {
    switch (storage.suits) {
        case Suits::any:
            return true;
        case Suits::non_negative:
            return traits.non_negative;
        case Suits::colours:
            return traits.colours;
        case Suits::bounded_by_lead:
            return !traits.lead_bounds.empty();
    }
    return false;
}

bool shares_texels(const Storage& storage) {
    const CoefficientTraits any{1, true, true, {1}};
    return shares_texels(storage.layout(any));
}

Result<const Storage*> find_storage(std::string_view name) {
    std::vector<std::string> known;
    for (const Storage& storage : k_storages) {
        if (storage.name == name) return &storage;
        known.emplace_back(storage.name);
    }
    return Error{"unknown storage \"" + std::string(name) + "\"" + nearest_names(name, known)};
}

Result<std::vector<const Storage*>> find_storages(std::span<const std::string> names, const CoefficientTraits& traits) {
    std::vector<const Storage*> found;
    for (const std::string& name : names) {
        const auto storage = find_storage(name);
        if (!storage) return storage.error();
        if (!suits(**storage, traits)) return unsuitable(**storage, traits);
        if (std::find(found.begin(), found.end(), *storage) == found.end()) found.push_back(*storage);
    }
    return found;
}

std::vector<const Storage*> default_storages(const CoefficientTraits& traits) {
    std::vector<const Storage*> chosen;
    for (const std::string_view name : {"float16", "ratio8"})
        if (const Storage* storage = find_storage(name).value(); suits(*storage, traits)) chosen.push_back(storage);
    return chosen;
}

void allowed_error(const Storage& storage, const CoefficientTraits& traits, const CoefficientPlanes& coefficients,
                   const MutableCoefficientPlanes& out) {
    const TextureLayout layout = storage.layout(traits);
    float largest = 0;
    for (const float* plane : coefficients.planes)
        largest = std::max(largest, largest_magnitude(plane, coefficients.size()));
    // What is too large for a format is divided first, and with it what the format can tell from 0.
    ErrorBound bound = storage.bound;
    bound.absolute *= storing_scale(layout.textures.front().format, largest);
    for (std::size_t p = 0; p < coefficients.planes.size(); ++p) {
        float in_texture = 0;
        for (std::size_t k = 0; bound.of_texture > 0 && k < 3; ++k)
            in_texture =
                std::max(in_texture, largest_magnitude(coefficients.planes[p / 3 * 3 + k], coefficients.size()));
        for (std::size_t i = 0; i < coefficients.size(); ++i) {
            const double allowed = bound_at(bound, traits, coefficients, p, i) + bound.of_texture * in_texture;
            out.planes[p][i] = is_within(storage, traits, coefficients, p, i) ? static_cast<float>(allowed) : HUGE_VALF;
        }
    }
}

std::vector<Rgb> stored_and_read(const Storage& storage, const CoefficientTraits& traits, std::span<const Rgb> c) {
    std::vector<float> in(3 * c.size()), back(in.size());
    CoefficientPlanes planes(1, 1, {});
    MutableCoefficientPlanes read(1, 1, {});
    for (std::size_t i = 0; i < c.size(); ++i) {
        in[3 * i] = c[i].r;
        in[3 * i + 1] = c[i].g;
        in[3 * i + 2] = c[i].b;
    }
    for (std::size_t p = 0; p < in.size(); ++p) {
        planes.planes.push_back(&in[p]);
        read.planes.push_back(&back[p]);
    }
    const TextureLayout layout = storage.layout(traits);
    unpack(layout, pack(layout, planes), read);
    std::vector<Rgb> result(c.size());
    for (std::size_t i = 0; i < c.size(); ++i) result[i] = {back[3 * i], back[3 * i + 1], back[3 * i + 2]};
    return result;
}

}  // namespace lobelia
