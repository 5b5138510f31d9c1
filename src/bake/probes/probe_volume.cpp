// Weights of probes, and the search of cells.
#include "lobelia/probe_volume.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/math/octahedral_map.h"

namespace lobelia {
namespace {

/// Probes below this validity count only where there are no others.
constexpr float k_least_validity = 0.5f, k_weight_of_invalid = 1e-6f;
/// Weights below this are dimmed further, smoothly: little light from behind walls becomes none.
constexpr float k_dim_below = 0.2f;

constexpr float k_least_weight = 1e-7f;

std::array<std::int64_t, 3> key_of(Vec3 position, Vec3 lowest, float size) {
    const auto step = [&](float p, float low) { return static_cast<std::int64_t>(std::floor((p - low) / size)); };
    return {step(position.x, lowest.x), step(position.y, lowest.y), step(position.z, lowest.z)};
}

Status check(const ProbeSet& probes, const Codec& codec) {
    const std::size_t n = probes.size();
    if (n == 0) return Error{"no probes"};
    if (!probes.grid && probes.cells.empty()) return Error{"probes without a grid and without cells have no places"};
    if (probes.coefficients_per_probe != codec.basis().size() ||
        probes.coefficients.size() != n * probes.coefficients_per_probe || probes.validity.size() != n)
        return Error{"coefficients or validities of the probes are missing"};
    if (probes.visibility_side > 0 && probes.visibility.size() != n * probes.visibility_side * probes.visibility_side)
        return Error{"maps of the probes' visibility are missing"};
    if (probes.grid &&
        static_cast<std::uint64_t>(probes.grid->count[0]) * probes.grid->count[1] * probes.grid->count[2] != n)
        return Error{"the grid of the probes does not have as many places as there are probes"};
    for (const ProbeCell& cell : probes.cells)
        for (const std::uint32_t corner : cell.corners)
            if (corner >= n || !(cell.size > 0)) return Error{"a cell of the probes has no size, or no such corner"};
    return Done{};
}

}  // namespace

float probe_weight(const ProbeAt& at, Vec3 normal) {
    float seen = 1;
    if (at.moments) {
        const auto [mean, square] = *at.moments;
        const float far = length(at.from_probe);
        const float facing = 0.5f + 0.5f * dot(at.to_probe, normal) / std::max(length(at.to_probe), 1e-6f);
        seen = facing * facing + 0.2f;
        if (far > mean) {
            const float variance = std::abs(square - mean * mean), beyond = far - mean;
            const float share = variance / std::max(variance + beyond * beyond, 1e-12f);
            seen = seen * share * share * share;
        }
        // Little light from behind walls becomes none.
        if (seen < k_dim_below) seen *= seen * seen / (k_dim_below * k_dim_below);
        seen = std::max(seen, k_least_weight);
    }
    return (at.trilinear + k_least_weight) * seen * (at.validity < k_least_validity ? k_weight_of_invalid : 1);
}

std::array<float, 2> probe_moments(std::span<const std::array<float, 2>> map, std::size_t side, Vec3 direction) {
    const auto [u, v] = OctahedralMap::place(direction);
    const OctahedralMap octahedral{side};
    const auto n = static_cast<float>(side);
    const float x = 0.5f * (u + 1) * n - 0.5f, y = 0.5f * (v + 1) * n - 0.5f;
    const float x0 = std::floor(x), y0 = std::floor(y), fx = x - x0, fy = y - y0;
    std::array<float, 2> sum{};
    for (int k = 0; k < 4; ++k) {
        const float weight = ((k & 1) != 0 ? fx : 1 - fx) * ((k & 2) != 0 ? fy : 1 - fy);
        const auto& texel = map[octahedral.index_at(static_cast<int>(x0) + (k & 1), static_cast<int>(y0) + (k >> 1))];
        sum[0] += weight * texel[0];
        sum[1] += weight * texel[1];
    }
    return sum;
}

Result<ProbeVolume> ProbeVolume::make(ProbeSet probes, const ProbeReading& reading) {
    auto codec = make_codec(probes.codec);
    if (!codec) return codec.error();
    if (Status status = check(probes, *codec); !status) return status.error();
    return ProbeVolume(std::move(probes), reading, *std::move(codec));
}

ProbeVolume::ProbeVolume(ProbeSet probes, const ProbeReading& reading, Codec codec)
    : probes_(std::move(probes)), reading_(reading), codec_(std::move(codec)) {
    const std::vector<ProbeCell>& cells = probes_.cells;
    if (cells.empty()) return;
    lowest_ = highest_ = cells.front().lowest;
    for (const ProbeCell& cell : cells) {
        lowest_ = {std::min(lowest_.x, cell.lowest.x), std::min(lowest_.y, cell.lowest.y),
                   std::min(lowest_.z, cell.lowest.z)};
        highest_ = {std::max(highest_.x, cell.lowest.x + cell.size), std::max(highest_.y, cell.lowest.y + cell.size),
                    std::max(highest_.z, cell.lowest.z + cell.size)};
    }
    order_.resize(cells.size());
    std::iota(order_.begin(), order_.end(), 0u);
    const auto key = [&](std::uint32_t i) {
        const float half = 0.5f * cells[i].size;
        return key_of(cells[i].lowest + Vec3{half, half, half}, lowest_, cells[i].size);
    };
    std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
        return cells[a].size != cells[b].size ? cells[a].size < cells[b].size : key(a) < key(b);
    });
    for (std::size_t i = 0; i < order_.size(); ++i) {
        const float size = cells[order_[i]].size;
        if (levels_.empty() || levels_.back().size != size) levels_.push_back({size, i, i});
        levels_.back().end = i + 1;
        keys_.push_back(key(order_[i]));
    }
}

ProbeVolume::Place ProbeVolume::place_in_grid(Vec3 position) const {
    const ProbeGrid& grid = *probes_.grid;
    Place place;
    place.size = std::min({grid.spacing.x, grid.spacing.y, grid.spacing.z});
    const std::array<float, 3> offset = {(position.x - grid.origin.x) / grid.spacing.x,
                                         (position.y - grid.origin.y) / grid.spacing.y,
                                         (position.z - grid.origin.z) / grid.spacing.z};
    std::array<std::uint32_t, 3> low{}, high{};
    std::array<float, 3> along{};
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t last = grid.count[k] - 1;
        const float steps = std::clamp(offset[k], 0.0f, static_cast<float>(last));
        low[k] = std::min(static_cast<std::uint32_t>(steps), last > 0 ? last - 1 : 0);
        high[k] = std::min(low[k] + 1, last);
        along[k] = std::min(steps - static_cast<float>(low[k]), 1.0f);
    }
    place.along = {along[0], along[1], along[2]};
    for (std::uint32_t corner = 0; corner < 8; ++corner) {
        const auto at = [&](std::size_t k) { return (corner >> k & 1) != 0 ? high[k] : low[k]; };
        place.probe[corner] = at(0) + grid.count[0] * (at(1) + grid.count[1] * at(2));
    }
    return place;
}

ProbeVolume::Place ProbeVolume::place_in_cells(Vec3 position) const {
    // Cells fill the box of the coarse grid; inside it there is always one.
    const auto inside = [](float p, float low, float high) { return std::clamp(p, low, std::nexttoward(high, low)); };
    const Vec3 p{inside(position.x, lowest_.x, highest_.x), inside(position.y, lowest_.y, highest_.y),
                 inside(position.z, lowest_.z, highest_.z)};
    std::uint32_t found = order_.back();
    for (const Level& level : levels_) {
        const auto key = key_of(p, lowest_, level.size);
        const auto begin = keys_.begin() + static_cast<std::ptrdiff_t>(level.begin);
        const auto end = keys_.begin() + static_cast<std::ptrdiff_t>(level.end);
        const auto at = std::lower_bound(begin, end, key);
        if (at == end || *at != key) continue;
        found = order_[static_cast<std::size_t>(at - keys_.begin())];
        break;
    }
    const ProbeCell& cell = probes_.cells[found];
    const Vec3 along = (p - cell.lowest) * (1 / cell.size);
    const auto unit = [](float x) { return std::clamp(x, 0.0f, 1.0f); };
    return {cell.corners, {unit(along.x), unit(along.y), unit(along.z)}, cell.size};
}

ProbeVolume::Corners ProbeVolume::corners(Vec3 position, Vec3 normal) const {
    const float bias = reading_.normal_bias;
    const Place first = probes_.grid ? place_in_grid(position) : place_in_cells(position);
    const Vec3 point = position + normal * (bias * first.size);
    const Place place = probes_.grid ? place_in_grid(point) : place_in_cells(point);
    const std::size_t side = probes_.visibility_side;
    Corners corners{place.probe, {}};
    float sum = 0;
    for (std::size_t k = 0; k < 8; ++k) {
        const std::uint32_t probe = place.probe[k];
        const auto share = [&](std::size_t axis, float along) { return (k >> axis & 1) != 0 ? along : 1 - along; };
        ProbeAt at;
        at.trilinear = share(0, place.along.x) * share(1, place.along.y) * share(2, place.along.z);
        at.to_probe = probes_.positions[probe] - position;
        at.from_probe = point - probes_.positions[probe];
        at.validity = probes_.validity[probe];
        const float far = length(at.from_probe);
        if (side > 0 && reading_.visibility == Switch::on)
            at.moments = probe_moments(std::span(probes_.visibility).subspan(probe * side * side, side * side), side,
                                       far > 0 ? at.from_probe * (1 / far) : normal);
        const float weight = probe_weight(at, normal);
        corners.weight[k] = weight;
        sum += weight;
    }
    for (float& weight : corners.weight) weight /= sum;
    return corners;
}

void ProbeVolume::coefficients(Vec3 position, Vec3 normal, std::span<Rgb> c) const {
    const std::size_t n = coefficients();
    check_equal("coefficients", c.size(), n);
    std::fill(c.begin(), c.end(), Rgb{});
    const Corners around = corners(position, normal);
    for (std::size_t k = 0; k < 8; ++k) {
        const Rgb* of_probe = probes_.coefficients.data() + around.probe[k] * n;
        for (std::size_t i = 0; i < n; ++i) c[i] = c[i] + of_probe[i] * around.weight[k];
    }
}

Rgb ProbeVolume::irradiance(Vec3 position, Vec3 normal) const {
    std::array<Rgb, 64> few;
    std::vector<Rgb> many;
    std::span<Rgb> c(few.data(), std::min(coefficients(), few.size()));
    if (coefficients() > few.size()) {
        many.resize(coefficients());
        c = many;
    }
    coefficients(position, normal, c);
    return codec_.irradiance(c, normal);
}

}  // namespace lobelia
