// Tests BC6H: the decoder agrees with Mesa in every mode; the encoder is exact where the format allows, stays within a
// block's range, gains from the second region, and agrees between instruction sets except for rounding.
#include "core/storage/format/bc6h/bc6h.h"

#include <map>

#include "core/math/half.h"
#include "core/storage/format/bc6h/bc6h_modes.h"
#include "support.h"
#include "targets.h"

namespace lobelia {
namespace {

using bc6h::Signedness;
constexpr std::array k_signs = {Signedness::unsigned_halves, Signedness::signed_halves};

int code_of(const std::byte* block) {
    const int low = std::to_integer<int>(block[0]) & 31;
    return (low & 3) < 2 ? low & 3 : low;
}

// ---- Decoding

/// Blocks of 16 bytes of mt19937's lowest eight bits, seed 1 (unsigned) and 2 (signed), 4096 each: by mode, the FNV-1a
/// hash of what Mesa 22.3 (llvmpipe) decodes, as halves, infinity taken for 65504. 19, 23, 27 and 31 are reserved.
const std::map<int, std::uint32_t> k_unsigned_answers = {
    {0, 0x892ff2ea},  {1, 0x214546d9},  {2, 0x835be72f},  {3, 0x033f85c9},  {6, 0x3f92bb82},  {7, 0xb4931272},
    {10, 0x42efa8a5}, {11, 0xace8458c}, {14, 0x0bc6d55f}, {15, 0xd2ef3ee8}, {18, 0x8b80b323}, {19, 0xd9d11305},
    {22, 0x9dead54a}, {23, 0x31641145}, {26, 0x39ee7865}, {27, 0x8f5b3a05}, {30, 0xc54a834c}, {31, 0x61f15005}};
const std::map<int, std::uint32_t> k_signed_answers = {
    {0, 0xa10cb728},  {1, 0x8355e5ca},  {2, 0x0c12c97e},  {3, 0xe1916550},  {6, 0xbab545c1},  {7, 0x7e91a3d1},
    {10, 0x62da0c81}, {11, 0x65cbaacd}, {14, 0x20a0c6b6}, {15, 0xd87cef0b}, {18, 0x0a404634}, {19, 0xd9d11305},
    {22, 0xe86b58d3}, {23, 0xa8cf2d85}, {26, 0x910fab52}, {27, 0x5fb3c505}, {30, 0x7c076fad}, {31, 0x007216c5}};

TEST(Bc6hDecoder, GivesKnownAnswersForEveryMode) {
    for (const Signedness sign : k_signs) {
        const auto& answers = sign == Signedness::unsigned_halves ? k_unsigned_answers : k_signed_answers;
        std::mt19937 generator(sign == Signedness::unsigned_halves ? 1 : 2);
        std::map<int, std::uint32_t> hashes;
        for (int n = 0; n < 4096; ++n) {
            std::array<std::byte, bc6h::k_block_bytes> block;
            for (auto& byte : block) byte = static_cast<std::byte>(generator() & 255);
            auto& hash = hashes.try_emplace(code_of(block.data()), 2166136261u).first->second;
            for (const auto& texel : bc6h::decode_block(block.data(), sign))
                for (const std::uint16_t half : texel)
                    hash = (hash ^ half_from_float(float_from_half(half))) * 16777619u;
        }
        EXPECT_EQ(hashes, answers);
    }
}

TEST(Bc6hTables, EveryModeUsesEveryBitOnce) {
    for (const bc6h::Mode& mode : bc6h::k_modes) {
        std::map<std::pair<int, int>, std::uint32_t> seen;
        int bits = mode.code_bits();
        for (const bc6h::Run& run : mode.runs)
            for (int i = 0; i < run.count; ++i, ++bits) {
                const std::uint32_t bit = 1u << (run.falling ? run.first - i : run.first + i);
                auto& field = seen[{run.endpoint, run.channel}];
                EXPECT_EQ(field & bit, 0u);
                field |= bit;
            }
        for (int endpoint = 0; endpoint < 2 * mode.regions; ++endpoint)
            for (int channel = 0; channel < 3; ++channel) {
                const auto difference = mode.difference[static_cast<std::size_t>(channel)];
                const int expected = endpoint > 0 && mode.has_differences() ? difference : mode.bits;
                EXPECT_EQ((seen[{endpoint, channel}]), (1u << expected) - 1) << int{mode.code};
            }
        bits += mode.regions == 2 ? 5 + 16 * 3 - 2 : 16 * 4 - 1;
        EXPECT_EQ(bits, 128) << int{mode.code};
    }
}

TEST(Bc6hTables, AnchorsAreWithinTheirRegions) {
    for (std::size_t p = 0; p < bc6h::k_partitions; ++p) {
        EXPECT_EQ(bc6h::k_second_region[p] & 1, 0);
        EXPECT_EQ(bc6h::k_second_region[p] >> bc6h::k_anchor[p] & 1, 1);
    }
}

// ---- Encoding

/// A block of 4 x 4 texels in three channels.
struct Block {
    float values[3][16] = {};
    [[nodiscard]] std::array<std::byte, bc6h::k_block_bytes> encoded(Signedness sign) const {
        const float* channels[3] = {values[0], values[1], values[2]};
        std::array<std::byte, bc6h::k_block_bytes> bytes;
        bc6h::encode_blocks(channels, 4, 1, sign, bytes.data());
        return bytes;
    }
    [[nodiscard]] Block through(Signedness sign) const {
        Block result;
        const auto texels = bc6h::decode_block(encoded(sign).data(), sign);
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t i = 0; i < 16; ++i) result.values[c][i] = float_from_half(texels[i][c]);
        return result;
    }
    [[nodiscard]] float low(std::size_t c) const { return *std::min_element(values[c], values[c] + 16); }
    [[nodiscard]] float high(std::size_t c) const { return *std::max_element(values[c], values[c] + 16); }
};

double root(float v) { return std::copysign(std::sqrt(std::abs(static_cast<double>(v))), v); }

/// Sum of squared differences of square roots, which the encoder minimises.
double error(const Block& a, const Block& b) {
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < 16; ++i) sum += std::pow(root(a.values[c][i]) - root(b.values[c][i]), 2);
    return sum;
}

class RandomBlocks {
  public:
    explicit RandomBlocks(std::uint32_t seed) : generator_(seed) {}
    float uniform() { return static_cast<float>(generator_()) * 0x1p-32f; }
    std::uint32_t number(std::uint32_t below) { return static_cast<std::uint32_t>(generator_()) % below; }

    /// The kinds of blocks in lightmaps: noise, gradients, two colours with an edge between, an outlier, a flat colour.
    Block block(Signedness sign) {
        Block b;
        const std::uint32_t kind = number(5);
        const float scale = std::ldexp(1.0f, static_cast<int>(number(20)) - 12);
        float ends[3][3];
        for (auto& end : ends)
            for (float& v : end) v = sign == Signedness::signed_halves ? 2 * uniform() - 1 : uniform();
        const float angle = 6.2831853f * uniform(), nx = std::cos(angle), ny = std::sin(angle),
                    at = 3 * uniform() - 1.5f;
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t i = 0; i < 16; ++i) {
                const float x = static_cast<float>(i % 4) - 1.5f, y = static_cast<float>(i / 4) - 1.5f;
                const float along = std::clamp((nx * x + ny * y) / 4.3f + 0.5f, 0.0f, 1.0f);
                float share = kind == 1 ? along : kind == 2 ? (nx * x + ny * y > at ? 1.0f : 0.0f) : 0.0f;
                if (kind == 3 && i == number(16)) share = 1;
                b.values[c][i] = scale * (ends[0][c] + share * (ends[1][c] - ends[0][c]));
                if (kind == 0)
                    b.values[c][i] = scale * (sign == Signedness::signed_halves ? 2 * uniform() - 1 : uniform());
            }
        return b;
    }

  private:
    std::mt19937 generator_;
};

TEST(Bc6hEncoder, FlatBlocksAreAsNearAsHalvesCanBe) {
    RandomBlocks random(1);
    for (const Signedness sign : k_signs)
        for (int n = 0; n < 2000; ++n) {
            Block b;
            for (auto& channel : b.values) {
                float v = std::ldexp(random.uniform(), static_cast<int>(random.number(40)) - 24);
                if (sign == Signedness::signed_halves && random.number(2) == 0) v = -v;
                std::fill_n(channel, 16, v);
            }
            const Block back = b.through(sign);
            // A value halfway between two half floats may round to either.
            for (std::size_t c = 0; c < 3; ++c)
                for (std::size_t i = 0; i < 16; ++i) {
                    const float v = b.values[c][i], nearest = float_from_half(half_from_float(v));
                    ASSERT_EQ(std::abs(back.values[c][i] - v), std::abs(nearest - v)) << v;
                }
        }
}

TEST(Bc6hEncoder, BlackAndTheLargestAreExact) {
    for (const float v : {0.0f, 65504.0f, 1e9f, 1e38f}) {
        Block b;
        for (auto& channel : b.values) std::fill_n(channel, 16, v);
        EXPECT_EQ(b.through(Signedness::unsigned_halves).values[1][7], std::min(v, 65504.0f));
        EXPECT_EQ(b.through(Signedness::signed_halves).values[1][7], std::min(v, 65504.0f));
    }
    // Unsigned blocks clamp negative values to 0.
    Block b;
    for (auto& channel : b.values) std::fill_n(channel, 16, -1.0f);
    EXPECT_EQ(b.through(Signedness::unsigned_halves).values[0][0], 0);
    EXPECT_EQ(b.through(Signedness::signed_halves).values[0][0], -1);
}

void expect_within_range(const Block& b, Signedness sign) {
    const Block back = b.through(sign);
    float range = 0;
    for (std::size_t c = 0; c < 3; ++c) range = std::max(range, b.high(c) - b.low(c));
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < 16; ++i)
            ASSERT_LE(std::abs(back.values[c][i] - b.values[c][i]),
                      range * 1.000001f + std::abs(b.values[c][i]) * 0x1p-10f + 0x1p-24f);
}

TEST(Bc6hEncoder, StaysWithinTheRangeOfTheBlock) {
    RandomBlocks random(2);
    for (const Signedness sign : k_signs)
        for (int n = 0; n < 5000; ++n) expect_within_range(random.block(sign), sign);
}

TEST(Bc6hEncoder, ABrightChannelThatHardlyVariesIsKept) {
    // The dark region needs endpoints far apart, which leaves few bits for the bright one.
    RandomBlocks random(6);
    for (int n = 0; n < 2000; ++n) {
        Block b;
        for (std::size_t i = 0; i < 16; ++i) {
            b.values[0][i] = 10 + 0.001f * random.uniform();
            b.values[1][i] = std::ldexp(random.uniform(), -static_cast<int>(random.number(14)) - 6);
            b.values[2][i] = n % 2 ? 0.3f : 0.01f * random.uniform();
        }
        expect_within_range(b, Signedness::unsigned_halves);
    }
}

TEST(Bc6hEncoder, TwoFlatRegionsAreKeptSharp) {
    // Two colours that differ in all channels, split by each partition: only that partition represents them.
    for (const Signedness sign : k_signs)
        for (std::size_t p = 0; p < bc6h::k_partitions; ++p) {
            Block b;
            for (std::size_t i = 0; i < 16; ++i) {
                const bool second = bc6h::k_second_region[p] >> i & 1;
                b.values[0][i] = second ? 0.2f : 1.0f;
                b.values[1][i] = second ? 0.9f : 0.3f;
                b.values[2][i] = second ? 0.4f : 0.5f;
            }
            const Block back = b.through(sign);
            for (std::size_t c = 0; c < 3; ++c)
                for (std::size_t i = 0; i < 16; ++i) EXPECT_NEAR(back.values[c][i], b.values[c][i], 0.012f) << p;
        }
}

TEST(Bc6hEncoder, ALineInEachRegionNeedsTwo) {
    // Two gradients of different hue: one line through both leaves much more.
    double total = 0;
    for (std::size_t p = 0; p < 16; ++p) {
        Block b;
        for (std::size_t i = 0; i < 16; ++i) {
            const bool second = bc6h::k_second_region[p] >> i & 1;
            const float t = 0.5f + 0.05f * static_cast<float>(i % 5);
            b.values[0][i] = second ? t : 0.3f;
            b.values[1][i] = second ? 0.3f : t;
            b.values[2][i] = second ? 0.2f : 0.6f;
        }
        EXPECT_LT(code_of(b.encoded(Signedness::unsigned_halves).data()) & 3, 3) << p;
        total += error(b, b.through(Signedness::unsigned_halves));
    }
    EXPECT_LT(std::sqrt(total / (16 * 48)), 0.012);  // of square roots around 0.7
}

TEST(Bc6hEncoder, SmoothBlocksAreNearlyExact) {
    RandomBlocks random(3);
    double squares = 0, signal = 0;
    for (int n = 0; n < 2000; ++n) {
        Block b;
        float base[3], dx[3], dy[3];
        for (std::size_t c = 0; c < 3; ++c) {
            base[c] = 0.2f + random.uniform();
            dx[c] = 0.02f * (random.uniform() - 0.5f);
            dy[c] = 0.02f * (random.uniform() - 0.5f);
        }
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t i = 0; i < 16; ++i)
                b.values[c][i] = base[c] + dx[c] * static_cast<float>(i % 4) + dy[c] * static_cast<float>(i / 4);
        squares += error(b, b.through(Signedness::unsigned_halves));
        for (const auto& channel : b.values)
            for (const float v : channel) signal += v;
    }
    EXPECT_LT(std::sqrt(squares / signal), 0.004);
}

TEST(Bc6hEncoder, IsTheSameOnAllTargetsButForRounding) {
    for (const Signedness sign : k_signs) {
        std::vector<double> totals;
        test::on_all_targets([&] {
            RandomBlocks random(4);
            double total = 0;
            for (int n = 0; n < 500; ++n) {
                const Block b = random.block(sign);
                total += error(b, b.through(sign)) / (1e-9 + root(b.high(0)) * root(b.high(0)));
            }
            totals.push_back(total);
        });
        for (const double total : totals) EXPECT_NEAR(total, totals.front(), 0.01 * totals.front());
    }
}

TEST(Bc6hEncoder, BlocksSideBySideAreThoseAlone) {
    RandomBlocks random(5);
    constexpr std::size_t blocks = 5;
    std::vector<float> rows[3];
    for (auto& r : rows) r.resize(4 * 4 * blocks);
    std::vector<Block> alone;
    for (std::size_t k = 0; k < blocks; ++k) {
        alone.push_back(random.block(Signedness::signed_halves));
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t i = 0; i < 16; ++i) rows[c][i / 4 * 4 * blocks + 4 * k + i % 4] = alone[k].values[c][i];
    }
    const float* channels[3] = {rows[0].data(), rows[1].data(), rows[2].data()};
    std::vector<std::byte> bytes(blocks * bc6h::k_block_bytes);
    bc6h::encode_blocks(channels, 4 * blocks, blocks, Signedness::signed_halves, bytes.data());
    for (std::size_t k = 0; k < blocks; ++k) {
        const auto expected = alone[k].encoded(Signedness::signed_halves);
        EXPECT_TRUE(std::equal(expected.begin(), expected.end(), &bytes[k * bc6h::k_block_bytes]));
    }
}

}  // namespace
}  // namespace lobelia
