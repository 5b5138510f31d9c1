// Integrals of a whole GGX lobe: albedo, mean direction and zonal part, by rays and from a table.
#include "core/math/ggx.h"

namespace lobelia::ggx {
namespace {

/// Entries along either side, and the rays that each is made from.
constexpr std::size_t k_lobe_side = k_table_side, k_table_rays = 1024;
/// Table coordinates from 0 to 1: roots of alpha and of the viewer's elevation above the surface, for the lobe changes
/// fastest where the surface is smooth and the view grazing. As the elevation counts 1 - sqrt(1 - cosine), which is
/// linear in the angle at the normal, where nothing bends, and needs no arc sine, here or in a shader.
struct Coordinates {
    float alpha, elevation;
};
Coordinates coordinates(const View& view) {
    return {std::sqrt(view.alpha), std::sqrt(view.cosine / (1 + std::sqrt(1 - view.cosine)))};
}
constexpr float k_lobe_last = static_cast<float>(k_lobe_side - 1);
View table_view(std::size_t i, std::size_t j) {
    const auto a = static_cast<float>(i) / k_lobe_last, root = static_cast<float>(j) / k_lobe_last;
    const float elevation = root * root;
    return make_view(elevation * (2 - elevation), a * a);
}

/// A lobe in numbers that bend little from entry to entry: the axis as the sine of its angle from the mirror direction,
/// less than a right angle, and the spread as a root relative to alpha, which both tend to 0 with it.
using LobeEntry = std::array<float, 4 + k_zonal_degree - 1>;

LobeEntry to_entry(const Lobe& lobe, const View& view) {
    const float tilt = -(lobe.axis.x * view.cosine + lobe.axis.z * view.sine);
    LobeEntry entry{lobe.albedo, lobe.fresnel, tilt, std::sqrt(lobe.spread) / view.alpha};
    for (std::size_t l = 2; l <= k_zonal_degree; ++l) entry[2 + l] = lobe.zonal[l];
    return entry;
}

Lobe from_entry(const LobeEntry& entry, const View& view) {
    Lobe lobe;
    lobe.albedo = entry[0];
    lobe.fresnel = entry[1];
    // The mirror direction (-sine, 0, cosine), turned by the tilt.
    const float s = entry[2], c = std::sqrt(1 - s * s);
    lobe.axis = {-(view.sine * c + view.cosine * s), 0, view.cosine * c - view.sine * s};
    const float root = entry[3] * view.alpha;
    lobe.spread = root * root;
    lobe.zonal[0] = 1;
    lobe.zonal[1] = 1 - lobe.spread;
    for (std::size_t l = 2; l <= k_zonal_degree; ++l) lobe.zonal[l] = entry[2 + l];
    return lobe;
}

std::vector<LobeEntry> make_lobe_table() {
    std::vector<LobeEntry> table(k_lobe_side * k_lobe_side);
    for (std::size_t i = 0; i < k_lobe_side; ++i)
        for (std::size_t j = 0; j < k_lobe_side; ++j) {
            const View view = table_view(i, j);
            table[i * k_lobe_side + j] = to_entry(lobe_by_rays(view, k_table_rays), view);
        }
    return table;
}

const std::vector<LobeEntry>& lobe_table() {
    static const std::vector<LobeEntry> k_table = make_lobe_table();
    return k_table;
}

/// The cell that a coordinate lies in, and where in it.
struct TablePlace {
    std::size_t index;
    float along;
    explicit TablePlace(float coordinate)
        : index(std::min(k_lobe_side - 2, static_cast<std::size_t>(std::max(0.0f, coordinate * k_lobe_last)))),
          along(std::clamp(coordinate * k_lobe_last - static_cast<float>(index), 0.0f, 1.0f)) {}
};

}  // namespace

Lobe lobe_by_rays(const View& view, std::size_t count) {
    const auto all = rays(view, count);
    const Vec3 v = view.direction();
    double albedo = 0, fresnel = 0, x = 0, z = 0;
    for (const Ray& ray : all) {
        const auto w = static_cast<double>(ray.weight);
        const double cosine = static_cast<double>(dot(v, normalize(v + ray.direction)));
        albedo += w;
        fresnel += w * std::pow(std::max(0.0, 1 - cosine), 5);
        x += w * static_cast<double>(ray.direction.x);
        z += w * static_cast<double>(ray.direction.z);
    }
    Lobe lobe;
    lobe.albedo = static_cast<float>(albedo);
    lobe.fresnel = static_cast<float>(fresnel);
    const double size = std::hypot(x, z);
    lobe.axis = {static_cast<float>(x / size), 0, static_cast<float>(z / size)};
    std::array<double, k_zonal_degree + 1> zonal{};
    double spread = 0;
    for (const Ray& ray : all) {
        const auto w = static_cast<double>(ray.weight);
        const Vec3 away = ray.direction - lobe.axis;
        const double short_of = 0.5 * static_cast<double>(dot(away, away)), c = 1 - short_of;
        spread += w * short_of;
        double before = 1, now = c;
        for (std::size_t l = 2; l <= k_zonal_degree; ++l) {
            const auto n = static_cast<double>(l);
            const double next = ((2 * n - 1) * c * now - (n - 1) * before) / n;
            before = now;
            now = next;
            zonal[l] += w * now;
        }
    }
    lobe.spread = static_cast<float>(spread / albedo);
    lobe.zonal[0] = 1;
    lobe.zonal[1] = 1 - lobe.spread;
    for (std::size_t l = 2; l <= k_zonal_degree; ++l) lobe.zonal[l] = static_cast<float>(zonal[l] / albedo);
    return lobe;
}

Lobe lobe(const View& view) {
    const std::vector<LobeEntry>& table = lobe_table();
    const auto [alpha, elevation] = coordinates(view);
    const TablePlace a(alpha), b(elevation);
    const LobeEntry* corner = &table[a.index * k_lobe_side + b.index];
    LobeEntry entry;
    for (std::size_t k = 0; k < entry.size(); ++k) {
        const float low = corner[0][k] + (corner[1][k] - corner[0][k]) * b.along;
        const float high = corner[k_lobe_side][k] + (corner[k_lobe_side + 1][k] - corner[k_lobe_side][k]) * b.along;
        entry[k] = low + (high - low) * a.along;
    }
    return from_entry(entry, view);
}

std::vector<float> table_texels() {
    const std::vector<LobeEntry>& table = lobe_table();
    std::vector<float> texels;
    for (std::size_t layer = 0; layer < k_table_layers; ++layer)
        for (const LobeEntry& entry : table)
            for (std::size_t k = 4 * layer; k < 4 * layer + 4; ++k) texels.push_back(k < entry.size() ? entry[k] : 0);
    return texels;
}

}  // namespace lobelia::ggx
