// Decodes BC6H, plainly: the definition that the encoder is held to.
#include "core/storage/format/bc6h/bc6h.h"
#include "core/storage/format/bc6h/bc6h_modes.h"

namespace lobelia::bc6h {
namespace {

/// Takes bits from the lowest on.
class BitReader {
  public:
    explicit BitReader(const std::byte* block) : block_(block) {}
    [[nodiscard]] int take(int count) {
        int value = 0;
        for (int i = 0; i < count; ++i, ++place_)
            value |= (std::to_integer<int>(block_[place_ / 8]) >> (place_ % 8) & 1) << i;
        return value;
    }

  private:
    const std::byte* block_;
    int place_ = 0;
};

int sign_extended(int value, int bits) { return value >> (bits - 1) & 1 ? value - (1 << bits) : value; }

const Mode* take_mode(BitReader& bits) {
    int code = bits.take(2);
    if (code >= 2) code |= bits.take(3) << 2;
    for (const Mode& mode : k_modes)
        if (mode.code == code) return &mode;
    return nullptr;
}

Endpoints take_endpoints(BitReader& bits, const Mode& mode) {
    Endpoints stored{};
    for (const Run& run : mode.runs) {
        if (run.count == 0) break;
        int& value = stored[run.endpoint][run.channel];
        for (int i = 0; i < run.count; ++i) value |= bits.take(1) << (run.falling ? run.first - i : run.first + i);
    }
    return stored;
}

/// Undoes differences and quantisation.
Endpoints widened(Endpoints e, const Mode& mode, Signedness sign) {
    const bool is_signed = sign == Signedness::signed_halves;
    const std::size_t count = mode.regions * std::size_t{2};
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t i = 0; i < count; ++i) {
            if (i > 0 && mode.has_differences())
                e[i][c] = (e[0][c] + sign_extended(e[i][c], mode.difference[c])) & ((1 << mode.bits) - 1);
            // The first stays as it is until the others were added to it: only its lower bits matter there.
        }
        for (std::size_t i = 0; i < count; ++i)
            e[i][c] = is_signed ? unquantized_signed(sign_extended(e[i][c], mode.bits), mode.bits)
                                : unquantized_unsigned(e[i][c], mode.bits);
    }
    return e;
}

/// Scales an interpolated number to the bits of a half.
std::uint16_t half_of(int value, Signedness sign) {
    if (sign == Signedness::unsigned_halves) return static_cast<std::uint16_t>(value * 31 >> 6);
    const int magnitude = (value < 0 ? -value : value) * 31 >> 5;
    return static_cast<std::uint16_t>(magnitude | (value < 0 ? 0x8000 : 0));
}

}  // namespace

Halves decode_block(const std::byte* block, Signedness sign) {
    Halves texels{};
    BitReader bits(block);
    const Mode* mode = take_mode(bits);
    if (!mode) return texels;
    const Endpoints e = widened(take_endpoints(bits, *mode), *mode, sign);
    const auto partition = static_cast<std::size_t>(mode->regions == 2 ? bits.take(k_partition_bits) : 0);
    for (std::size_t i = 0; i < k_texels; ++i) {
        const std::size_t region = mode->regions == 2 ? k_second_region[partition] >> i & 1 : 0;
        const bool is_anchor = i == 0 || (mode->regions == 2 && i == k_anchor[partition]);
        const auto index = static_cast<std::size_t>(bits.take(index_bits(*mode) - (is_anchor ? 1 : 0)));
        const int weight = mode->regions == 1 ? k_weights4[index] : k_weights3[index];
        for (std::size_t c = 0; c < 3; ++c) {
            const int mixed = (e[2 * region][c] * (64 - weight) + e[2 * region + 1][c] * weight + 32) >> 6;
            texels[i][c] = half_of(mixed, sign);
        }
    }
    return texels;
}

}  // namespace lobelia::bc6h
