// Texture lookups.
#include "trace/texture.h"

#include <algorithm>
#include <cmath>

#include "core/math/colour.h"

namespace lobelia {
namespace {

std::array<float, 256> make_table(Curve curve) {
    std::array<float, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
        const double value = static_cast<double>(i) / 255;
        table[i] = static_cast<float>(curve == Curve::srgb ? linear_from_srgb(value) : value);
    }
    return table;
}

/// Maps texel index i, of any value, into a row or column of n texels.
std::size_t wrapped(std::int64_t i, std::int64_t n, Texture::Wrap wrap) {
    switch (wrap) {
        case Texture::Wrap::clamp:
            return static_cast<std::size_t>(std::clamp<std::int64_t>(i, 0, n - 1));
        case Texture::Wrap::repeat:
            return static_cast<std::size_t>(((i % n) + n) % n);
        case Texture::Wrap::mirror: {
            const std::int64_t period = 2 * n, m = ((i % period) + period) % period;
            return static_cast<std::size_t>(m < n ? m : period - 1 - m);
        }
    }
    return 0;
}

/// The two texels next to a coordinate, and the distance to the first [texels]; unfiltered: the nearest texel.
struct Neighbours {
    std::size_t first, second;
    float share;
};
Neighbours neighbours(float coordinate, std::size_t size, Texture::Wrap wrap, Texture::Filter filter) {
    // Larger coordinates have no fraction in float; the limit also keeps the integer part in range.
    constexpr float most = 0x1p24f;
    const float bounded = std::isfinite(coordinate) ? std::clamp(coordinate, -most, most) : 0;
    const double at = static_cast<double>(bounded) * static_cast<double>(size) - 0.5;
    auto i = static_cast<std::int64_t>(at);
    if (static_cast<double>(i) > at) --i;
    const auto n = static_cast<std::int64_t>(size);
    if (filter == Texture::Filter::nearest) {
        const std::size_t texel = wrapped(static_cast<std::int64_t>(std::floor(at + 0.5)), n, wrap);
        return {texel, texel, 0};
    }
    return {wrapped(i, n, wrap), wrapped(i + 1, n, wrap), static_cast<float>(at - static_cast<double>(i))};
}

}  // namespace

std::array<float, 4> texture_value(const Texture& texture, Vec2 uv, Curve curve) {
    static const std::array tables = {make_table(Curve::linear), make_table(Curve::srgb)};
    const auto& linear = tables[0];
    const auto& colour = tables[curve == Curve::srgb ? 1 : 0];
    const auto [x0, x1, fx] = neighbours(uv.x, texture.width, texture.wrap_u, texture.filter);
    const auto [y0, y1, fy] = neighbours(uv.y, texture.height, texture.wrap_v, texture.filter);

    std::array<float, 4> sum{};
    const auto add = [&](std::size_t x, std::size_t y, float weight) {
        const auto& texel = texture.texels[y * texture.width + x];
        for (std::size_t k = 0; k < 3; ++k) sum[k] += weight * colour[texel[k]];
        sum[3] += weight * linear[texel[3]];
    };
    add(x0, y0, (1 - fx) * (1 - fy));
    add(x1, y0, fx * (1 - fy));
    add(x0, y1, (1 - fx) * fy);
    add(x1, y1, fx * fy);
    return sum;
}

}  // namespace lobelia
