// The tables of BC6H: what each mode's bits mean, which texels belong to the second region, interpolation weights.
// Khronos Data Format Specification 1.3, "BPTC".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace lobelia::bc6h {

/// Quantised endpoints: w and x of the first region, y and z of the second; three channels each.
using Endpoints = std::array<std::array<int, 3>, 4>;

/// Consecutive bits of a block that are consecutive bits of one endpoint's channel, rising, or falling in some modes.
struct Run {
    std::uint8_t endpoint = 0, channel = 0;
    std::uint8_t first = 0;  ///< the endpoint's bit at the lowest place
    std::uint8_t count = 0;
    bool falling = false;
};

struct Mode {
    std::uint8_t code;  ///< the lowest bits, 2 where it is below 2, else 5
    std::uint8_t regions;
    std::uint8_t bits;                       ///< of w; of all where nothing is a difference
    std::array<std::uint8_t, 3> difference;  ///< bits of x, y, z as differences to w, by channel; 0: no differences
    std::array<Run, 32> runs;                ///< from the bit after the code, up to one with count 0

    [[nodiscard]] constexpr int code_bits() const { return code < 2 ? 2 : 5; }
    [[nodiscard]] constexpr bool has_differences() const { return difference[0] != 0; }
};

/// Reads a layout as it is written below: "rw0-9 gy4" is ten bits of red of endpoint w, rising, then bit 4 of green of
/// y.
constexpr std::array<Run, 32> runs_of(std::string_view layout) {
    std::array<Run, 32> runs{};
    std::size_t n = 0, i = 0;
    const auto number = [&] {
        int value = 0;
        while (i < layout.size() && layout[i] >= '0' && layout[i] <= '9') value = value * 10 + (layout[i++] - '0');
        return value;
    };
    while (i < layout.size()) {
        Run& run = runs[n++];
        run.channel = layout[i] == 'r' ? 0 : layout[i] == 'g' ? 1 : 2;
        run.endpoint = static_cast<std::uint8_t>(layout[i + 1] - 'w');
        i += 2;
        const int first = number();
        int last = first;
        if (i < layout.size() && layout[i] == '-') {
            ++i;
            last = number();
        }
        run.first = static_cast<std::uint8_t>(first);
        run.falling = last < first;
        run.count = static_cast<std::uint8_t>((run.falling ? first - last : last - first) + 1);
        while (i < layout.size() && layout[i] == ' ') ++i;
    }
    return runs;
}

/// Modes 1 to 14 in the order of Direct3D's documentation.
inline constexpr std::array<Mode, 14> k_modes = {{
    {0,
     2,
     10,
     {5, 5, 5},
     runs_of("gy4 by4 bz4 rw0-9 gw0-9 bw0-9 rx0-4 gz4 gy0-3 gx0-4 bz0 gz0-3 bx0-4 bz1 by0-3 ry0-4 bz2 rz0-4 bz3")},
    {1,
     2,
     7,
     {6, 6, 6},
     runs_of("gy5 gz4 gz5 rw0-6 bz0 bz1 by4 gw0-6 by5 bz2 gy4 bw0-6 bz3 bz5 bz4 rx0-5 gy0-3 gx0-5 gz0-3 bx0-5 by0-3 "
             "ry0-5 rz0-5")},
    {2,
     2,
     11,
     {5, 4, 4},
     runs_of("rw0-9 gw0-9 bw0-9 rx0-4 rw10 gy0-3 gx0-3 gw10 bz0 gz0-3 bx0-3 bw10 bz1 by0-3 ry0-4 bz2 rz0-4 bz3")},
    {6,
     2,
     11,
     {4, 5, 4},
     runs_of("rw0-9 gw0-9 bw0-9 rx0-3 rw10 gz4 gy0-3 gx0-4 gw10 gz0-3 bx0-3 bw10 bz1 by0-3 ry0-3 bz0 bz2 rz0-3 gy4 "
             "bz3")},
    {10,
     2,
     11,
     {4, 4, 5},
     runs_of("rw0-9 gw0-9 bw0-9 rx0-3 rw10 by4 gy0-3 gx0-3 gw10 bz0 gz0-3 bx0-4 bw10 by0-3 ry0-3 bz1 bz2 rz0-3 bz4 "
             "bz3")},
    {14,
     2,
     9,
     {5, 5, 5},
     runs_of("rw0-8 by4 gw0-8 gy4 bw0-8 bz4 rx0-4 gz4 gy0-3 gx0-4 bz0 gz0-3 bx0-4 bz1 by0-3 ry0-4 bz2 rz0-4 bz3")},
    {18,
     2,
     8,
     {6, 5, 5},
     runs_of("rw0-7 gz4 by4 gw0-7 bz2 gy4 bw0-7 bz3 bz4 rx0-5 gy0-3 gx0-4 bz0 gz0-3 bx0-4 bz1 by0-3 ry0-5 rz0-5")},
    {22,
     2,
     8,
     {5, 6, 5},
     runs_of("rw0-7 bz0 by4 gw0-7 gy5 gy4 bw0-7 gz5 bz4 rx0-4 gz4 gy0-3 gx0-5 gz0-3 bx0-4 bz1 by0-3 ry0-4 bz2 rz0-4 "
             "bz3")},
    {26,
     2,
     8,
     {5, 5, 6},
     runs_of("rw0-7 bz1 by4 gw0-7 by5 gy4 bw0-7 bz5 bz4 rx0-4 gz4 gy0-3 gx0-4 bz0 gz0-3 bx0-5 by0-3 ry0-4 bz2 rz0-4 "
             "bz3")},
    {30,
     2,
     6,
     {0, 0, 0},
     runs_of("rw0-5 gz4 bz0 bz1 by4 gw0-5 gy5 by5 bz2 gy4 bw0-5 gz5 bz3 bz5 bz4 rx0-5 gy0-3 gx0-5 gz0-3 bx0-5 by0-3 "
             "ry0-5 rz0-5")},
    {3, 1, 10, {0, 0, 0}, runs_of("rw0-9 gw0-9 bw0-9 rx0-9 gx0-9 bx0-9")},
    {7, 1, 11, {9, 9, 9}, runs_of("rw0-9 gw0-9 bw0-9 rx0-8 rw10 gx0-8 gw10 bx0-8 bw10")},
    {11, 1, 12, {8, 8, 8}, runs_of("rw0-9 gw0-9 bw0-9 rx0-7 rw11-10 gx0-7 gw11-10 bx0-7 bw11-10")},
    {15, 1, 16, {4, 4, 4}, runs_of("rw0-9 gw0-9 bw0-9 rx0-3 rw15-10 gx0-3 gw15-10 bx0-3 bw15-10")},
}};

inline constexpr std::size_t k_partitions = 32;
inline constexpr int k_partition_bits = 5;

/// Bit i of a mask: texel i belongs to the second region.
inline constexpr std::array<std::uint16_t, k_partitions> k_second_region = {
    0xcccc, 0x8888, 0xeeee, 0xecc8, 0xc880, 0xfeec, 0xfec8, 0xec80, 0xc800, 0xffec, 0xfe80,
    0xe800, 0xffe8, 0xff00, 0xfff0, 0xf000, 0xf710, 0x008e, 0x7100, 0x08ce, 0x008c, 0x7310,
    0x3100, 0x8cce, 0x088c, 0x3110, 0x6666, 0x366c, 0x17e8, 0x0ff0, 0x718e, 0x399c};

/// The texel of the second region whose index lacks its highest bit, which is 0; of the first region it is texel 0.
inline constexpr std::array<std::uint8_t, k_partitions> k_anchor = {
    15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 2, 8, 2, 2, 8, 8, 15, 2, 8, 2, 2, 8, 8, 2, 2};

/// Shares of the second endpoint in 64ths, for indices of 4 and of 3 bits.
inline constexpr std::array<int, 16> k_weights4 = {0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64};
inline constexpr std::array<int, 8> k_weights3 = {0, 9, 18, 27, 37, 46, 55, 64};

[[nodiscard]] constexpr int index_bits(const Mode& mode) { return mode.regions == 1 ? 4 : 3; }

/// An endpoint's channel, of which `bits` were stored, as a number of 16 bits (unsigned) or 15 bits and a sign.
[[nodiscard]] constexpr int unquantized_unsigned(int stored, int bits) {
    if (bits >= 15 || stored == 0) return stored;
    return stored == (1 << bits) - 1 ? 0xffff : ((stored << 16) + 0x8000) >> bits;
}
[[nodiscard]] constexpr int unquantized_signed(int stored, int bits) {
    if (bits >= 16 || stored == 0) return stored;
    const int magnitude = stored < 0 ? -stored : stored;
    const int wide = magnitude >= (1 << (bits - 1)) - 1 ? 0x7fff : ((magnitude << 15) + 0x4000) >> (bits - 1);
    return stored < 0 ? -wide : wide;
}

}  // namespace lobelia::bc6h
