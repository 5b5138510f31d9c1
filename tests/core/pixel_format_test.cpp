// Tests every pixel format: kernels against plain forms on all instruction sets, round trips, any bytes, any size.
#include "lobelia/pixel_format.h"

#include <cstring>
#include <functional>

#include "core/math/half.h"
#include "core/storage/format/logluv.h"
#include "core/storage/format/rgb9e5.h"
#include "core/storage/format/rgbe.h"
#include "core/storage/format/rgbm.h"
#include "core/storage/format/unorm.h"
#include "support.h"
#include "targets.h"

namespace lobelia {
namespace {

/// Four channels of numbers of every magnitude, half of them within [0, 1], with corner cases first.
class Channels {
  public:
    Channels(std::size_t count, std::uint32_t seed) : values_(4, std::vector<float>(count)) {
        std::mt19937 generator(seed);
        const auto uniform = [&] { return static_cast<float>(generator()) * 0x1p-32f; };
        constexpr float corners[] = {0,        -0.0f,   1,       0.5f,      65504,    65520,
                                     65408,    1e30f,   -1e30f,  0x1p-24f,  0x1p-25f, 0x1.8p-25f,
                                     0x1p-14f, 511.75f, 255.75f, 0x1p-101f, 1e-38f,   -1};
        for (auto& channel : values_)
            for (std::size_t i = 0; i < count; ++i) {
                const float sign = generator() % 8 == 0 ? -1.0f : 1.0f;
                const float wide = std::ldexp(1 + uniform(), static_cast<int>(generator() % 60) - 40);
                channel[i] = i < std::size(corners) ? corners[generator() % std::size(corners)]
                                                    : sign * (generator() % 2 ? uniform() : wide);
            }
        for (auto& channel : values_) pointers_.push_back(channel.data());
    }
    [[nodiscard]] ChannelPointers first(std::size_t count) const { return std::span(pointers_).first(count); }
    [[nodiscard]] Rgb rgb(std::size_t i) const { return {values_[0][i], values_[1][i], values_[2][i]}; }
    [[nodiscard]] float at(std::size_t channel, std::size_t i) const { return values_[channel][i]; }

  private:
    std::vector<std::vector<float>> values_;
    std::vector<const float*> pointers_;
};

std::vector<std::byte> encoded(PixelFormat format, std::size_t width, std::size_t height, ChannelPointers channels) {
    std::vector<std::byte> bytes(byte_size(format, width, height));
    encode_texels(format, width, height, channels, bytes);
    return bytes;
}

std::vector<std::vector<float>> decoded(PixelFormat format, std::size_t width, std::size_t height,
                                        std::span<const std::byte> bytes) {
    std::vector<std::vector<float>> channels(info(format).channels, std::vector<float>(width * height));
    std::vector<float*> pointers;
    for (auto& channel : channels) pointers.push_back(channel.data());
    decode_texels(format, width, height, bytes, pointers);
    return channels;
}

template <class Word>
Word word_at(const std::vector<std::byte>& bytes, std::size_t i) {
    Word word;
    std::memcpy(&word, bytes.data() + i * sizeof word, sizeof word);
    return word;
}

// ---- Against the plain forms

constexpr std::size_t k_count = 5000;

TEST(PixelFormats, HalvesAreThoseOfThePlainForm) {
    const Channels in(k_count, 1);
    test::on_all_targets([&] {
        for (const auto& [format, channels] :
             {std::pair{PixelFormat::r16f, 1}, {PixelFormat::rg16f, 2}, {PixelFormat::rgba16f, 4}}) {
            const auto n = static_cast<std::size_t>(channels);
            const auto bytes = encoded(format, k_count, 1, in.first(n));
            const auto back = decoded(format, k_count, 1, bytes);
            for (std::size_t i = 0; i < k_count; ++i)
                for (std::size_t k = 0; k < n; ++k) {
                    const auto half = word_at<std::uint16_t>(bytes, i * n + k);
                    ASSERT_EQ(half, half_from_float(in.at(k, i))) << in.at(k, i);
                    ASSERT_EQ(back[k][i], float_from_half(half));
                }
        }
    });
}

TEST(PixelFormats, EveryHalfDecodesAsItself) {
    std::vector<std::byte> bytes(2 * 65536);
    for (std::uint32_t i = 0; i < 65536; ++i) {
        const auto half = static_cast<std::uint16_t>(i);
        std::memcpy(&bytes[2 * i], &half, 2);
    }
    test::on_all_targets([&] {
        const auto back = decoded(PixelFormat::r16f, 65536, 1, bytes);
        for (std::uint32_t i = 0; i < 65536; ++i) {
            const float expected = float_from_half(static_cast<std::uint16_t>(i));
            ASSERT_TRUE(back[0][i] == expected || (std::isnan(expected) && std::isnan(back[0][i]))) << i;
        }
    });
}

TEST(PixelFormats, NumbersOfBitsAreThoseOfThePlainForm) {
    const Channels in(k_count, 2);
    test::on_all_targets([&] {
        for (const auto& [format, channels] :
             {std::pair{PixelFormat::r8, 1}, {PixelFormat::rg8, 2}, {PixelFormat::rgba8, 4}}) {
            const auto n = static_cast<std::size_t>(channels);
            const auto bytes = encoded(format, k_count, 1, in.first(n));
            const auto back = decoded(format, k_count, 1, bytes);
            for (std::size_t i = 0; i < k_count; ++i)
                for (std::size_t k = 0; k < n; ++k) {
                    const auto byte = std::to_integer<std::uint32_t>(bytes[i * n + k]);
                    ASSERT_EQ(byte, texels::unorm_from_float(in.at(k, i), 255));
                    ASSERT_EQ(back[k][i], texels::float_from_unorm(byte, 255));
                }
        }
        const auto bytes = encoded(PixelFormat::rgb10a2, k_count, 1, in.first(3));
        const auto back = decoded(PixelFormat::rgb10a2, k_count, 1, bytes);
        for (std::size_t i = 0; i < k_count; ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                const auto part = word_at<std::uint32_t>(bytes, i) >> 10 * k & 1023;
                ASSERT_EQ(part, texels::unorm_from_float(in.at(k, i), 1023));
                ASSERT_EQ(back[k][i], texels::float_from_unorm(part, 1023));
            }
    });
}

/// Checks that a colour format's kernels encode and decode the same words as its plain form.
void expect_colours(PixelFormat format, const std::function<std::uint32_t(Rgb)>& to,
                    const std::function<Rgb(std::uint32_t)>& from) {
    const Channels in(k_count, 3);
    test::on_all_targets([&] {
        const auto bytes = encoded(format, k_count, 1, in.first(3));
        const auto back = decoded(format, k_count, 1, bytes);
        for (std::size_t i = 0; i < k_count; ++i) {
            const auto word = word_at<std::uint32_t>(bytes, i);
            ASSERT_EQ(word, to(in.rgb(i))) << in.rgb(i).r << " " << in.rgb(i).g << " " << in.rgb(i).b;
            ASSERT_EQ((Rgb{back[0][i], back[1][i], back[2][i]}), from(word));
        }
    });
}

TEST(PixelFormats, Rgb9e5IsItsPlainForm) {
    expect_colours(PixelFormat::rgb9e5, texels::rgb9e5_from, texels::rgb_from_rgb9e5);
}
TEST(PixelFormats, RgbeIsItsPlainForm) { expect_colours(PixelFormat::rgbe8, texels::rgbe_from, texels::rgb_from_rgbe); }
TEST(PixelFormats, RgbmIsItsPlainForm) { expect_colours(PixelFormat::rgbm8, texels::rgbm_from, texels::rgb_from_rgbm); }

TEST(PixelFormats, LogluvIsItsPlainFormButForRounding) {
    const Channels in(k_count, 4);
    test::on_all_targets([&] {
        const auto bytes = encoded(PixelFormat::logluv32, k_count, 1, in.first(3));
        const auto back = decoded(PixelFormat::logluv32, k_count, 1, bytes);
        std::size_t different = 0;
        for (std::size_t i = 0; i < k_count; ++i) {
            const auto word = word_at<std::uint32_t>(bytes, i), plain = texels::logluv_from(in.rgb(i));
            if (word != plain) ++different;
            for (const int shift : {0, 8})
                ASSERT_LE(std::abs(static_cast<int>(word >> shift & 255) - static_cast<int>(plain >> shift & 255)), 1);
            ASSERT_LE(std::abs(static_cast<int>(word >> 16) - static_cast<int>(plain >> 16)), 1);
            const Rgb expected = texels::rgb_from_logluv(word);
            const float scale = std::max({expected.r, expected.g, expected.b}) * 1e-5f;
            ASSERT_NEAR(back[0][i], expected.r, scale);
            ASSERT_NEAR(back[1][i], expected.g, scale);
            ASSERT_NEAR(back[2][i], expected.b, scale);
        }
        EXPECT_LE(different, k_count / 500);
    });
}

// ---- Known answers

TEST(PixelFormats, KnownTexels) {
    EXPECT_EQ(texels::rgb9e5_from({1, 0.5f, 0}), 0x80010100u);  // 256, 128, 0 times 2^(16 - 24)
    EXPECT_EQ(texels::rgb9e5_from({65408, 65408, 65408}), 0xffffffffu);
    // A value that would round up to the next exponent is rounded down, so the other channels keep their precision.
    EXPECT_EQ(texels::rgb9e5_from({511.75f, 1, 0}), texels::rgb9e5_from({511, 1, 0}));
    EXPECT_EQ(texels::rgbe_from({255.75f, 1, 0}), texels::rgbe_from({255, 1, 0}));
    EXPECT_EQ(texels::rgbe_from({1, 0.5f, 0}), 0x81004080u);  // 128, 64, 0 times 2^(129 - 136)
    EXPECT_EQ(texels::rgbm_from({1, 0.5f, 0}), 0xff0080ffu);
    EXPECT_EQ(texels::rgbm_from({0.5f, 0.5f, 0.5f}), 0x80fefefeu);
    // White of luminance 1: log2 Y = 0 at step 64 * 256, u' = 0.1978, v' = 0.4683.
    EXPECT_EQ(texels::logluv_from({1, 1, 1}) >> 16, 16384u);
    EXPECT_EQ(texels::logluv_from({1, 1, 1}) & 0xffff, 81u << 8 | 192u);
}

// ---- All formats

TEST(PixelFormats, TheTableIsComplete) {
    for (const PixelFormat format : pixel_formats()) {
        const FormatInfo& f = info(format);
        SCOPED_TRACE(f.name);
        EXPECT_TRUE(f.channels >= 1 && f.channels <= 4);
        EXPECT_TRUE(f.block == 1 || f.block == 4);
        EXPECT_EQ(byte_size(format, f.block, f.block), f.block_bytes);
        EXPECT_EQ(byte_size(format, f.block + 1, 1), 2 * f.block_bytes);
        EXPECT_GT(f.highest, 0);
        EXPECT_TRUE(f.lowest == 0 || f.lowest == -f.highest);
        EXPECT_GT(f.vk_format, 0u);
    }
}

TEST(PixelFormats, WhatWasReadOnceIsReadAgain) {
    const Channels in(k_count, 5);
    for (const PixelFormat format : pixel_formats()) {
        // Encoding again may choose another rgbm8 factor and other block endpoints.
        if (format == PixelFormat::rgbm8 || format == PixelFormat::logluv32 || info(format).block > 1) continue;
        SCOPED_TRACE(info(format).name);
        const auto once = decoded(format, k_count, 1, encoded(format, k_count, 1, in.first(info(format).channels)));
        std::vector<const float*> pointers;
        for (const auto& channel : once) pointers.push_back(channel.data());
        EXPECT_EQ(decoded(format, k_count, 1, encoded(format, k_count, 1, pointers)), once);
    }
}

TEST(PixelFormats, EverySizeAndPlaceGivesTheSame) {
    const Channels in(40, 6);
    for (const PixelFormat format : pixel_formats()) {
        if (info(format).block > 1) continue;
        SCOPED_TRACE(info(format).name);
        const auto whole = encoded(format, 40, 1, in.first(info(format).channels));
        for (const std::size_t count : {1, 2, 15, 16, 17, 33, 40}) {
            const std::size_t size = byte_size(format, count, 1);
            const auto bytes = encoded(format, count, 1, in.first(info(format).channels));
            EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), whole.begin())) << count;
            // Decode from unaligned bytes, as within a file.
            std::vector<std::byte> odd(size + 1);
            encode_texels(format, count, 1, in.first(info(format).channels), std::span(odd).subspan(1));
            EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), odd.begin() + 1)) << count;
            EXPECT_EQ(decoded(format, count, 1, std::span(odd).subspan(1)), decoded(format, count, 1, bytes));
        }
    }
}

TEST(PixelFormats, AnyBytesCanBeRead) {
    std::mt19937 generator(7);
    for (const PixelFormat format : pixel_formats()) {
        std::vector<std::byte> bytes(byte_size(format, 61, 9));
        for (auto& byte : bytes) byte = static_cast<std::byte>(generator());
        const auto channels = decoded(format, 61, 9, bytes);
        EXPECT_EQ(channels.size(), info(format).channels);
    }
}

TEST(PixelFormats, NothingThatIsNotFiniteDoesHarm) {
    std::vector<float> values(64);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = i % 4 == 0 ? NAN : i % 4 == 1 ? INFINITY : i % 4 == 2 ? -INFINITY : 3e38f;
    const std::vector<const float*> pointers(4, values.data());
    for (const PixelFormat format : pixel_formats())
        EXPECT_FALSE(encoded(format, 8, 8, std::span(pointers).first(info(format).channels)).empty());
}

TEST(PixelFormats, ScalesBringEverythingWithinReach) {
    for (const PixelFormat format : pixel_formats())
        for (const float largest : {1e-30f, 0.3f, 0.5f, 1.0f, 1.5f, 65408.0f, 65504.0f, 70000.0f, 1e30f, 1e38f}) {
            const float scale = storing_scale(format, largest);
            EXPECT_LE(largest / scale, info(format).highest) << info(format).name;
            int exponent = 0;
            EXPECT_EQ(std::frexp(scale, &exponent), 0.5f);
            if (format == PixelFormat::rgbm8) {
                EXPECT_GT(largest / scale, 0.5f);
            } else if (largest < 0x1p-10f && info(format).highest > 1 && info(format).highest < 66000) {
                // They would vanish in a format of half range.
                EXPECT_GT(largest / scale, 0.5f);
                EXPECT_LE(largest / scale, 1);
            } else if (largest <= info(format).highest) {
                EXPECT_EQ(scale, 1);
            }
        }
}

TEST(PixelFormats, LargestMagnitude) {
    std::vector<float> values(100, 1.0f);
    for (const std::size_t count : {1, 16, 37, 100}) {
        values[count - 1] = -static_cast<float>(count) - 1;
        test::on_all_targets(
            [&] { EXPECT_EQ(largest_magnitude(values.data(), count), static_cast<float>(count) + 1); });
    }
}

}  // namespace
}  // namespace lobelia
