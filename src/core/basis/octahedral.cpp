// Octahedral texels: irradiance from centroids.
#include "core/basis/octahedral.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "core/basis/octahedral_shader.h"
#include "core/basis/turned_block.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/basis/octahedral.cpp"
#include <hwy/foreach_target.h>  // NOLINT: must precede highway.h
#include <hwy/highway.h>
// NOLINTNEXTLINE: after highway.h
#include "core/math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lobelia::HWY_NAMESPACE {

/// row = omega times the mean of max(0, t + x), t = mean . n, x uniform in [-w, w] with the variance of w . n.
void CentroidRow(const OctahedralTexels::Centroid& cell, DirectionView block, float* row) {
    const D d;
    const auto k = [&](std::size_t i, float factor) HWY_ATTR { return hn::Set(d, factor * cell.variance[i]); };
    // The width is sqrt(3 variance).
    const V xx = k(0, 3), yy = k(1, 3), zz = k(2, 3), xy = k(3, 6), yz = k(4, 6), xz = k(5, 6);
    const V omega = hn::Set(d, cell.solid_angle), zero = hn::Zero(d);
    for (std::size_t j = 0; j < block.size; j += hn::Lanes(d)) {
        const Lanes3 n = load(d, block, j);
        const V along_x = hn::MulAdd(xx, n.x, hn::MulAdd(xy, n.y, hn::Mul(xz, n.z)));
        const V along_y = hn::MulAdd(yy, n.y, hn::Mul(yz, n.z));
        const V squared = hn::MulAdd(along_x, n.x, hn::MulAdd(along_y, n.y, hn::Mul(hn::Mul(zz, n.z), n.z)));
        const V w = hn::Sqrt(hn::Max(squared, hn::Set(d, 1e-8f)));
        const V t = dot(d, cell.mean, n);
        const V ramp = hn::Min(hn::Max(hn::Add(t, w), zero), hn::Add(w, w));
        const V above = hn::Max(hn::Sub(t, w), zero);
        const V at_horizon = hn::Div(hn::Mul(ramp, ramp), hn::Mul(hn::Set(d, 4.0f), w));
        hn::StoreU(hn::Mul(omega, hn::Add(at_horizon, above)), d, row + j);
    }
}

}  // namespace lobelia::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobelia {

HWY_EXPORT(CentroidRow);

namespace {

constexpr std::size_t k_highest_resolution = 64;

class Centroids final : public LinearEvaluator {
  public:
    Centroids(std::vector<OctahedralTexels::Centroid> cells, const Rotation& map_from_domain)
        : cells_(std::move(cells)), map_from_domain_(map_from_domain) {}
    [[nodiscard]] std::string name() const override { return "centroid"; }
    [[nodiscard]] Accuracy accuracy() const override {
        return {"resolution 8 and more", "0.5 % of the largest E of a cell, where the horizon cuts it"};
    }
    [[nodiscard]] std::size_t size() const override { return cells_.size(); }
    void values(DirectionView block, float* rows) const override {
        const TurnedBlock turned(block, map_from_domain_);
        for (std::size_t i = 0; i < cells_.size(); ++i)
            HWY_DYNAMIC_DISPATCH(CentroidRow)(cells_[i], turned.view(), rows + i * k_block_size);
    }
    [[nodiscard]] Result<ShaderCode> irradiance_code() const override {
        return octahedral::centroid_code(cells_, map_from_domain_);
    }

  private:
    std::vector<OctahedralTexels::Centroid> cells_;
    Rotation map_from_domain_;
};

}  // namespace

OctahedralTexels::OctahedralTexels(std::size_t resolution, const Rotation& map_from_domain)
    : map_{resolution}, map_from_domain_(map_from_domain) {
    check_equal("remainder of the resolution over 2", resolution % 2, 0);
    check_range("resolution", resolution, 2, k_highest_resolution);
    for (std::size_t i = 0; i < map_.size(); ++i) {
        const OctahedralMap::Cell cell = map_.cell(i);
        std::array<double, 3> mean{};
        for (std::size_t k = 0; k < 3; ++k) mean[k] = cell.first_moment[k] / cell.solid_angle;
        Centroid centroid{{static_cast<float>(mean[0]), static_cast<float>(mean[1]), static_cast<float>(mean[2])},
                          {},
                          static_cast<float>(cell.solid_angle)};
        for (std::size_t k = 0; k < 6; ++k)
            centroid.variance[k] = static_cast<float>(cell.second_moment[k] / cell.solid_angle -
                                                      mean[k % 3] * mean[k < 3 ? k : (k + 1) % 3]);
        centroids_.push_back(centroid);
    }
}

std::shared_ptr<const LinearBasis> octahedral_texels(std::size_t resolution) {
    return std::make_shared<OctahedralTexels>(resolution);
}

Result<std::shared_ptr<const Basis>> OctahedralTexels::from_name(std::string_view name) {
    if (!name.starts_with("oct")) return std::shared_ptr<const Basis>();
    std::size_t resolution = 0;
    const auto [end, error] = std::from_chars(name.data() + 3, name.data() + name.size(), resolution);
    if (error == std::errc::invalid_argument || end != name.data() + name.size()) return std::shared_ptr<const Basis>();
    if (error != std::errc() || resolution < 2 || resolution % 2 != 0 || resolution > k_highest_resolution)
        return Error{"basis \"" + std::string(name) + "\": the resolution must be even, 2 to 64"};
    return std::shared_ptr<const Basis>(std::make_shared<OctahedralTexels>(resolution));
}

void OctahedralTexels::values(DirectionView block, float* rows) const {
    for (std::size_t i = 0; i < size(); ++i) std::fill_n(rows + i * k_block_size, block.size, 0.0f);
    for (std::size_t j = 0; j < block.size; ++j)
        rows[map_.index(rotate(map_from_domain_, direction_at(block, j))) * k_block_size + j] = 1;
}

void OctahedralTexels::values_at(Vec3 direction, float* values) const {
    std::fill_n(values, size(), 0.0f);
    values[map_.index(rotate(map_from_domain_, direction))] = 1;
}

Rgb OctahedralTexels::radiance_at(std::span<const Rgb> c, Vec3 direction) const {
    check_equal("coefficients", c.size(), size());
    return c[map_.index(rotate(map_from_domain_, direction))];
}

void OctahedralTexels::radiance(std::span<const Rgb> c, DirectionView directions, MutableColourView out) const {
    check_evaluation(size(), c, directions, out);
    for (std::size_t j = 0; j < directions.size; ++j)
        set_entry(out, j, OctahedralTexels::radiance_at(c, direction_at(directions, j)));
}

Result<ShaderCode> OctahedralTexels::radiance_code() const { return octahedral::radiance_code(*this); }

std::string OctahedralTexels::description() const {
    return "octahedral texels: constant radiance in " + std::to_string(map_.resolution) + " x " +
           std::to_string(map_.resolution) + " cells";
}

Matrix OctahedralTexels::gram() const {
    Matrix result(size() * size());
    for (std::size_t i = 0; i < size(); ++i) result[i * size() + i] = map_.cell(i).solid_angle;
    return result;
}

std::vector<double> OctahedralTexels::integrals() const {
    std::vector<double> result;
    for (std::size_t i = 0; i < size(); ++i) result.push_back(map_.cell(i).solid_angle);
    return result;
}

std::shared_ptr<const Evaluator> OctahedralTexels::evaluator(std::string_view name) const {
    return name == "centroid" ? std::make_shared<Centroids>(centroids_, map_from_domain_) : nullptr;
}

Basis::Rotated OctahedralTexels::rotated(const Rotation& r, std::span<const Rgb> c) const {
    check_equal("coefficients", c.size(), size());
    // w' = R w is looked up at M R^T w'.
    Rotation turned;
    for (std::size_t i = 0; i < 3; ++i) turned[i] = rotate(r, map_from_domain_[i]);
    return {std::make_shared<OctahedralTexels>(map_.resolution, turned), {c.begin(), c.end()}};
}

}  // namespace lobelia
#endif
