// Groups light sources by position: splits at medians, the group with the largest error first.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <tuple>

#include "trace/light/light_source.h"

namespace lobelia {
namespace {

/// Maximum number of groups of near sources.
constexpr std::size_t k_most_near_groups = 32;
/// A group of intensity I and radius r is split while I r^2 exceeds this fraction of total intensity times the square
/// of the radius around all sources: above it the group's weight would be inaccurate for points near it.
constexpr float k_division = 0.01f;

/// Returns a sphere that encloses the spheres of all sources, centred in the box of their centres.
std::pair<Vec3, float> bounds(std::span<const LightSource> sources) {
    Vec3 lowest = sources[0].centre, highest = lowest;
    for (const LightSource& s : sources) {
        lowest = {std::min(lowest.x, s.centre.x), std::min(lowest.y, s.centre.y), std::min(lowest.z, s.centre.z)};
        highest = {std::max(highest.x, s.centre.x), std::max(highest.y, s.centre.y), std::max(highest.z, s.centre.z)};
    }
    const Vec3 centre = (lowest + highest) * 0.5f;
    float radius = 0;
    for (const LightSource& s : sources) radius = std::max(radius, length(s.centre - centre) + s.radius);
    return {centre, radius};
}

float total_strength(std::span<const LightSource> sources) {
    double sum = 0;
    for (const LightSource& s : sources) sum += static_cast<double>(s.strength);
    return static_cast<float>(sum);
}

/// Estimates the error of a group's weight.
float weight_error(std::span<const LightSource> sources) {
    const float radius = bounds(sources).second;
    return sources.size() == 1 ? 0 : total_strength(sources) * radius * radius;
}

/// Sorts the sources by their centres along the longest axis of the centres' box.
void sort_along_longest_axis(std::span<LightSource> sources) {
    constexpr std::array axes = {&Vec3::x, &Vec3::y, &Vec3::z};
    const auto before = [](float Vec3::*axis) {
        return [axis](const LightSource& a, const LightSource& b) { return a.centre.*axis < b.centre.*axis; };
    };
    float Vec3::*longest = axes[0];
    float most = -1;
    for (float Vec3::*axis : axes) {
        const auto [low, high] = std::minmax_element(sources.begin(), sources.end(), before(axis));
        const float extent = high->centre.*axis - low->centre.*axis;
        if (extent > most) most = extent, longest = axis;
    }
    std::stable_sort(sources.begin(), sources.end(), before(longest));
}

}  // namespace

std::vector<std::vector<LightSource>> grouped_by_place(std::vector<LightSource> sources) {
    std::vector<std::vector<LightSource>> groups;
    std::vector<float> errors{weight_error(sources)};
    groups.push_back(std::move(sources));
    const float tolerated = k_division * errors[0];
    while (groups.size() < k_most_near_groups) {
        const auto worst = static_cast<std::size_t>(std::max_element(errors.begin(), errors.end()) - errors.begin());
        if (!(errors[worst] > tolerated)) break;
        std::vector<LightSource>& group = groups[worst];
        sort_along_longest_axis(group);
        const auto middle = group.begin() + static_cast<std::ptrdiff_t>(group.size() / 2);
        std::vector<LightSource> second(middle, group.end());
        group.erase(middle, group.end());
        errors[worst] = weight_error(group);
        errors.push_back(weight_error(second));
        groups.push_back(std::move(second));
    }
    return groups;
}

LightGroup make_group(std::span<LightSource> sources, std::uint32_t first) {
    assert(!sources.empty());
    using Kind = LightSource::Kind;
    LightGroup group;
    group.first = first;
    group.far = sources[0].kind == Kind::environment || sources[0].kind == Kind::sun;
    group.strength = total_strength(sources);
    if (!group.far) std::tie(group.centre, group.radius) = bounds(sources);
    if (sources.size() == 1) {
        group.centre = sources[0].centre;
        group.radius = sources[0].radius;
    } else {
        std::vector<float> strengths;
        for (const LightSource& s : sources) strengths.push_back(s.strength);
        group.table.emplace(strengths);
        for (std::size_t i = 0; i < sources.size(); ++i)
            sources[i].share = static_cast<float>(group.table->probability(i));
    }

    // One-sided triangles that all face one way are invisible from behind the rearmost of them.
    const Vec3 front = sources[0].front;
    group.least = std::numeric_limits<float>::lowest();
    if (std::all_of(sources.begin(), sources.end(),
                    [&](const LightSource& s) { return dot(s.front, front) > 1 - 1e-6f; })) {
        group.front = front;
        group.least = std::min_element(sources.begin(), sources.end(), [](const auto& a, const auto& b) {
                          return a.least < b.least;
                      })->least;
    }
    return group;
}

}  // namespace lobelia
