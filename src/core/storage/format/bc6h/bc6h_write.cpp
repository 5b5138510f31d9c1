// Quantises endpoints of BC6H blocks and writes blocks.
#include "core/storage/format/bc6h/bc6h_write.h"

#include <algorithm>
#include <span>

#include "lobelia/contract.h"

namespace lobelia::bc6h {
namespace {

/// Modes of one region and of two, the more precise first. Those of 11 and of 8 bits differ in which channel may move
/// further.
constexpr std::array<std::uint8_t, 4> k_one_region = {13, 12, 11, 10};
constexpr std::array<std::uint8_t, 10> k_two_regions = {2, 3, 4, 0, 5, 6, 7, 8, 1, 9};

/// The stored number whose unquantised form is nearest to `wide`, a whole number.
int quantised(int wide, int bits, Signedness sign) {
    if (bits >= 16) return wide;
    const int magnitude = wide < 0 ? -wide : wide, sign_bits = sign == Signedness::signed_halves ? 1 : 0;
    const int stored = std::min(magnitude >> (16 - bits), (1 << (bits - sign_bits)) - 1);
    return wide < 0 ? -stored : stored;
}

int unquantised(int stored, int bits, Signedness sign) {
    return sign == Signedness::signed_halves ? unquantized_signed(stored, bits) : unquantized_unsigned(stored, bits);
}

/// Whether the differences to w have few enough bits.
bool fits(const Endpoints& e, const Mode& mode) {
    if (!mode.has_differences()) return true;
    for (std::size_t i = 1; i < mode.regions * std::size_t{2}; ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            const int difference = e[i][c] - e[0][c], limit = 1 << (mode.difference[c] - 1);
            if (difference < -limit || difference >= limit) return false;
        }
    return true;
}

/// Appends bits from the lowest place on.
class BitWriter {
  public:
    void put(int value, int count) {
        const std::uint64_t bits = static_cast<std::uint64_t>(value) & ((std::uint64_t{1} << count) - 1);
        words_[place_ / 64] |= bits << (place_ % 64);
        if (place_ % 64 + count > 64) words_[1] |= bits >> (64 - place_ % 64);
        place_ += count;
    }
    void store(std::byte* block) const {
        LOBELIA_ASSERT(place_ == 128);
        for (std::size_t i = 0; i < k_block_bytes; ++i) block[i] = static_cast<std::byte>(words_[i / 8] >> (i % 8 * 8));
    }

  private:
    std::uint64_t words_[2] = {};
    int place_ = 0;
};

void put_run(const Run& run, int value, BitWriter& bits) {
    if (!run.falling) {
        bits.put(value >> run.first, run.count);
        return;
    }
    for (int i = 0; i < run.count; ++i) bits.put(value >> (run.first - i), 1);
}

}  // namespace

Quantised quantised(const WideEndpoints& e, std::size_t regions, Signedness sign) {
    const std::span<const std::uint8_t> order =
        regions == 1 ? std::span<const std::uint8_t>(k_one_region) : std::span<const std::uint8_t>(k_two_regions);
    Quantised q;
    Endpoints whole{};
    for (std::size_t i = 0; i < 2 * regions; ++i)
        for (std::size_t c = 0; c < 3; ++c) whole[i][c] = static_cast<int>(e[i][c] + (e[i][c] < 0 ? -0.5f : 0.5f));
    int bits = 0;
    for (const std::uint8_t number : order) {
        q.mode = &k_modes[number];
        for (std::size_t i = 0; i < 2 * regions && q.mode->bits != bits; ++i)
            for (std::size_t c = 0; c < 3; ++c) q.stored[i][c] = quantised(whole[i][c], q.mode->bits, sign);
        bits = q.mode->bits;
        if (fits(q.stored, *q.mode)) break;
    }
    for (std::size_t i = 0; i < 2 * regions; ++i)
        for (std::size_t c = 0; c < 3; ++c) q.wide[i][c] = unquantised(q.stored[i][c], bits, sign);
    return q;
}

Quantised flat(const std::array<int, 3>& wide) {
    Quantised q{&k_modes[k_one_region.front()], {}, {}};
    q.stored[0] = q.stored[1] = q.wide[0] = q.wide[1] = wide;
    return q;
}

void write_block(const Quantised& q, std::size_t partition, const std::array<std::uint8_t, k_texels>& indices,
                 std::byte* block) {
    const Mode& mode = *q.mode;
    BitWriter bits;
    bits.put(mode.code, mode.code_bits());
    for (const Run& run : mode.runs) {
        if (run.count == 0) break;
        const int base = run.endpoint > 0 && mode.has_differences() ? q.stored[0][run.channel] : 0;
        put_run(run, q.stored[run.endpoint][run.channel] - base, bits);
    }
    if (mode.regions == 2) bits.put(static_cast<int>(partition), k_partition_bits);
    for (std::size_t i = 0; i < k_texels; ++i) {
        const bool is_anchor = i == 0 || (mode.regions == 2 && i == k_anchor[partition]);
        LOBELIA_ASSERT(!is_anchor || indices[i] < 1 << (index_bits(mode) - 1));
        bits.put(indices[i], index_bits(mode) - (is_anchor ? 1 : 0));
    }
    bits.store(block);
}

}  // namespace lobelia::bc6h
