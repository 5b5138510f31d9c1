// Six irradiances: the fit to E by its moments, and the interpolation by squares.
#include "core/basis/ambient_cube_irradiance.h"

#include "core/basis/cosine_lobes_shader.h"
#include "core/basis/sh/spherical_harmonics.h"
#include "core/math/harmonics_degree_2.h"
#include "core/math/least_squares.h"
#include "core/math/shader_text.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/basis/ambient_cube_irradiance.cpp"
#include <hwy/foreach_target.h>  // NOLINT: must precede highway.h
#include <hwy/highway.h>
// NOLINTNEXTLINE: after highway.h
#include "core/math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lobelia::HWY_NAMESPACE {

/// out = scale times the sum over three axes of (n . axis)^2 times the colour of the side that n faces.
void SidesRows(const Rgb* c, const Rotation& cube, float scale, DirectionView normals, MutableColourView out) {
    const D d;
    for (std::size_t j = 0; j < normals.size; j += hn::Lanes(d)) {
        const Lanes3 n = load(d, normals, j);
        V r = hn::Zero(d), g = r, b = r;
        for (std::size_t i = 0; i < 3; ++i) {
            const V along = dot(d, cube[i], n), squared = hn::Mul(along, along);
            const auto back = hn::Lt(along, hn::Zero(d));
            const auto side = [&](float front_colour, float back_colour) HWY_ATTR {
                return hn::IfThenElse(back, hn::Set(d, scale * back_colour), hn::Set(d, scale * front_colour));
            };
            r = hn::MulAdd(squared, side(c[2 * i].r, c[2 * i + 1].r), r);
            g = hn::MulAdd(squared, side(c[2 * i].g, c[2 * i + 1].g), g);
            b = hn::MulAdd(squared, side(c[2 * i].b, c[2 * i + 1].b), b);
        }
        store(d, r, out.channel(0), j, out.size);
        store(d, g, out.channel(1), j, out.size);
        store(d, b, out.channel(2), j, out.size);
    }
}

}  // namespace lobelia::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobelia {

HWY_EXPORT(SidesRows);

namespace {

constexpr std::size_t k_sides = 6, k_accumulated = 9;

void read_sides(std::span<const Rgb> c, const Rotation& cube, float scale, DirectionView normals,
                MutableColourView out) {
    check_evaluation(k_sides, c, normals, out);
    HWY_DYNAMIC_DISPATCH(SidesRows)(c.data(), cube, scale, normals, out);
}

std::array<Vec3, 6> sides_of(const Rotation& cube) {
    return {cube[0], cube[0] * -1.0f, cube[1], cube[1] * -1.0f, cube[2], cube[2] * -1.0f};
}

class Squares final : public Evaluator {
  public:
    explicit Squares(const Rotation& cube_from_domain) : cube_from_domain_(cube_from_domain) {}
    [[nodiscard]] std::string name() const override { return "squares"; }
    [[nodiscard]] Accuracy accuracy() const override {
        return {"everywhere", "exact by definition", Reading::of_its_own, 1e-5};
    }
    void signed_irradiance(std::span<const Rgb> c, DirectionView normals, MutableColourView out) const override {
        read_sides(c, cube_from_domain_, 1, normals, out);
    }
    [[nodiscard]] Result<ShaderCode> irradiance_code() const override {
        return cosine_lobes::sum_of_squares(sides_of(cube_from_domain_), "n", "e");
    }

  private:
    Rotation cube_from_domain_;
};

}  // namespace

Result<std::shared_ptr<const Basis>> AmbientCubeIrradiance::from_name(std::string_view name) {
    if (name != "ambient-cube-e") return std::shared_ptr<const Basis>();
    const Rotation upright{Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    return std::shared_ptr<const Basis>(std::make_shared<AmbientCubeIrradiance>(upright));
}

std::shared_ptr<const LinearBasis> AmbientCubeIrradiance::accumulated() const {
    return std::make_shared<SphericalHarmonics>(2);
}

void AmbientCubeIrradiance::fit(std::span<const Rgb> accumulated, std::span<Rgb> c) const {
    check_equal("accumulated coefficients", accumulated.size(), k_accumulated);
    check_equal("coefficients", c.size(), k_sides);
    // Squared clamped cosines of the six sides against each other.
    Matrix gram(36);
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = 0; j < 6; ++j) gram[i * 6 + j] = i == j ? 2 * k_pi / 5 : i / 2 == j / 2 ? 0 : k_pi / 15;

    for (std::size_t k = 0; k < 3; ++k) {
        // The integral of E max(0, n . a)^2 is that of L pi/8 (1 + w . a)^2, which degree 2 knows exactly.
        const Degree2 light = degree_2(accumulated, k);
        std::array<double, 6> m{};
        for (std::size_t i = 0; i < 6; ++i) {
            const Vec3 axis = cube_from_domain_[i / 2] * (i % 2 == 0 ? 1.0f : -1.0f);
            const std::array<double, 3> a = {axis.x, axis.y, axis.z};
            const double mean = 4 * k_pi * light.constant, first = 4 * k_pi / 3 * light.first(a);
            const double second = mean / 3 + 8 * k_pi / 15 * light.second(a);
            m[i] = k_pi / 8 * (mean + 2 * first + second);
        }
        const auto found = non_negative_least_squares(gram, m);
        for (std::size_t i = 0; i < 6; ++i) set_channel(c[i], k, found[i]);
    }
}

void AmbientCubeIrradiance::radiance(std::span<const Rgb> c, DirectionView directions, MutableColourView out) const {
    read_sides(c, cube_from_domain_, k_over_pi, directions, out);
}

Result<ShaderCode> AmbientCubeIrradiance::radiance_code() const {
    ShaderCode code = cosine_lobes::sum_of_squares(sides_of(cube_from_domain_), "w", "sum");
    code.result = shader_text::literal(k_over_pi) + " * sum";
    return code;
}

std::string AmbientCubeIrradiance::description() const {
    return "ambient cube of irradiances: six colours, interpolated by squared cosines";
}

std::shared_ptr<const Evaluator> AmbientCubeIrradiance::evaluator(std::string_view name) const {
    return name == "squares" ? std::make_shared<Squares>(cube_from_domain_) : nullptr;
}

Basis::Rotated AmbientCubeIrradiance::rotated(const Rotation& r, std::span<const Rgb> c) const {
    check_equal("coefficients", c.size(), k_sides);
    const Rotation& m = cube_from_domain_;
    const Rotation turned{rotate(r, m[0]), rotate(r, m[1]), rotate(r, m[2])};
    return {std::make_shared<AmbientCubeIrradiance>(turned), {c.begin(), c.end()}};
}

}  // namespace lobelia
#endif
