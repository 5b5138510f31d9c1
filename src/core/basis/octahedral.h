// Octahedral texels: constant radiance in each of N x N cells that tile the sphere. The big reference among bases, and
// what lobes are fitted from. Praun and Hoppe 2003; Engelhardt and Dachsbacher 2008.
#pragma once

#include <array>

#include "core/math/octahedral_map.h"
#include "lobelia/bases.h"

namespace lobelia {

class OctahedralTexels final : public LinearBasis {
  public:
    explicit OctahedralTexels(std::size_t resolution,
                              const Rotation& map_from_domain = {Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    /// oct<N>, N even, 2 to 64. Null if the name is of another family.
    [[nodiscard]] static Result<std::shared_ptr<const Basis>> from_name(std::string_view name);

    [[nodiscard]] std::size_t size() const override { return map_.size(); }
    void values(DirectionView block, float* rows) const override;
    void values_at(Vec3 direction, float* values) const override;
    void radiance(std::span<const Rgb> c, DirectionView directions, MutableColourView out) const override;
    [[nodiscard]] Rgb radiance_at(std::span<const Rgb> c, Vec3 direction) const override;
    [[nodiscard]] Result<ShaderCode> radiance_code() const override;
    [[nodiscard]] std::string name() const override { return "oct" + std::to_string(map_.resolution); }
    [[nodiscard]] std::string description() const override;
    [[nodiscard]] Domain domain() const override { return Domain::sphere; }
    [[nodiscard]] bool is_non_negative() const override { return true; }
    [[nodiscard]] Matrix gram() const override;
    [[nodiscard]] std::vector<double> integrals() const override;
    /// centroid: each cell as its solid angle at its mean direction, blended over its width where the horizon cuts it.
    [[nodiscard]] std::vector<std::string> evaluator_names() const override { return {"centroid"}; }
    [[nodiscard]] std::shared_ptr<const Evaluator> evaluator(std::string_view name) const override;
    [[nodiscard]] Rotated rotated(const Rotation& r, std::span<const Rgb> c) const override;

    [[nodiscard]] const OctahedralMap& map() const { return map_; }
    [[nodiscard]] const Rotation& map_from_domain() const { return map_from_domain_; }
    /// Each cell in short, in the frame of the map: mean direction (shorter than 1), the variance of w about it (xx,
    /// yy, zz, xy, yz, xz), solid angle.
    struct Centroid {
        Vec3 mean;
        std::array<float, 6> variance{};
        float solid_angle = 0;
    };

  private:
    OctahedralMap map_;
    Rotation map_from_domain_;
    std::vector<Centroid> centroids_;
};

}  // namespace lobelia
