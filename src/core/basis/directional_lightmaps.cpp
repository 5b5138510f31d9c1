// Directional lightmaps: the moments they need, the constrained fit, the forms of storage.
#include "core/basis/directional_lightmaps.h"

#include <algorithm>

#include "core/basis/hemisphere_polynomials.h"
#include "core/math/dense.h"
#include "core/math/harmonics_degree_2.h"
#include "core/math/quadrature.h"
#include "core/math/shader_pattern.h"
#include "core/math/shader_text.h"
#include "core/math/zonal_quadratic.h"

namespace lobelia {
namespace {

using Kind = DirectionalLightmap::Kind;

constexpr std::array k_kinds = {std::pair{Kind::sh1h, "sh1h"}, std::pair{Kind::irradz, "irradz"},
                                std::pair{Kind::enlighten, "enlighten"},
                                std::pair{Kind::enlighten_rgb, "enlighten-rgb"}};

/// Converts degree-1 coefficients to E and back: E = pi Y_0 c_0 + 2 pi / 3 sqrt(3 / 4 pi) (c_3, c_1, c_2) . n.
const double k_constant_factor = std::sqrt(k_pi) / 2;
const double k_slope_factor = std::sqrt(k_pi / 3);

/// Moments of the light of one channel: integrals over the hemisphere of L, L z, and L times the irradiances of x, y,
/// z.
using Moments = std::array<double, 5>;

std::array<Moments, 3> moments_from(std::span<const Rgb> accumulated) {
    static const Matrix gram = NormalMoments().gram();
    std::array<Moments, 3> result{};
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < 5; ++i)
            for (std::size_t j = 0; j < 5; ++j) result[k][i] += gram[i * 5 + j] * channel_of(accumulated[j], k);
    return result;
}

/// The least integral over the upper normals of |e0 + e . n - E(n)|^2 with e0 + e_z = E(z), which is the moment of z.
/// With E(z) + e_z (z - 1) in place of e0 + e_z z one unknown is left; the integral of (z - 1)^2 is 2 pi / 3.
LinearIrradiance constrained(const Moments& m) {
    const double at_normal = m[1], mean = k_pi / 2 * (m[0] + m[1]);  // of E over the upper normals, times 2 pi
    const double up = (m[4] - mean + k_pi * at_normal) / (2 * k_pi / 3);
    return {at_normal - up, {m[2] / (2 * k_pi / 3), m[3] / (2 * k_pi / 3), up}};
}

/// The nearest E that has the same value at the surface's normal and is nowhere negative, |e| <= e0: with e0 = E(z) -
/// e_z that is e_z <= (E(z)^2 - r^2) / 2 E(z), r^2 = e_x^2 + e_y^2, a paraboloid, and near means near in e.
LinearIrradiance non_negative(const LinearIrradiance& e) {
    const double at_normal = e.constant + e.slope[2], r = std::hypot(e.slope[0], e.slope[1]);
    if (!(at_normal > 0)) return {};
    const auto height = [&](double radius) { return (at_normal * at_normal - radius * radius) / (2 * at_normal); };
    if (e.slope[2] <= height(r)) return e;
    // The foot of the perpendicular, by bisection.
    double low = 0, high = r;
    for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        const bool beyond = middle - r - (height(middle) - e.slope[2]) * middle / at_normal > 0;
        (beyond ? high : low) = middle;
    }
    const double shrink = r > 0 ? low / r : 0, up = height(low);
    return {at_normal - up, {e.slope[0] * shrink, e.slope[1] * shrink, up}};
}

/// The slope of that over its constant.
std::array<double, 3> directionality(const LinearIrradiance& e) {
    const LinearIrradiance bright = non_negative(e);
    std::array<double, 3> d{};
    if (bright.constant > 0)
        for (std::size_t i = 0; i < 3; ++i) d[i] = bright.slope[i] / bright.constant;
    return d;
}

LinearIrradiance luminance_of(const std::array<LinearIrradiance, 3>& e) {
    const double weights[] = {0.2126, 0.7152, 0.0722};
    LinearIrradiance sum;
    for (std::size_t k = 0; k < 3; ++k) {
        sum.constant += weights[k] * e[k].constant;
        for (std::size_t i = 0; i < 3; ++i) sum.slope[i] += weights[k] * e[k].slope[i];
    }
    return sum;
}

/// Integrals of L Y from coefficients of the orthonormal polynomials 1, y, 2z - 1, x.
void fit_dark_below(std::span<const Rgb> h, std::span<Rgb> c) {
    const auto k0 = static_cast<float>(1 / HemispherePolynomials::factor(0)),
               k1 = static_cast<float>(1 / HemispherePolynomials::factor(1));
    const auto y0 = static_cast<float>(std::sqrt(1 / (4 * k_pi))), y1 = static_cast<float>(std::sqrt(3 / (4 * k_pi)));
    const Rgb of_one = h[0] * k0;
    c[0] = of_one * y0;
    c[1] = h[1] * (k1 * y1);
    c[2] = (h[2] * k1 + of_one) * (y1 / 2);
    c[3] = h[3] * (k1 * y1);
}

class LinearInNormal final : public Evaluator {
  public:
    LinearInNormal(Kind kind, Negative negative) : basis_(kind), negative_(negative) {}
    [[nodiscard]] std::string name() const override {
        return negative_ == Negative::clamped ? "linear" : "linear-signed";
    }
    [[nodiscard]] Negative negative() const override { return negative_; }
    [[nodiscard]] Accuracy accuracy() const override {
        return {"normals above the horizon", "1e-6 of the largest E (float32 rounding)"};
    }
    void signed_irradiance(std::span<const Rgb> c, DirectionView normals, MutableColourView out) const override {
        check_evaluation(basis_.size(), c, normals, out);
        std::array<ZonalQuadratic, 3> functions;
        const auto e = basis_.irradiance(c);
        for (std::size_t k = 0; k < 3; ++k)
            functions[k] = {static_cast<float>(e[k].constant),
                            {static_cast<float>(e[k].slope[0]), static_cast<float>(e[k].slope[1]),
                             static_cast<float>(e[k].slope[2])}};
        evaluate(functions, normals, out);
    }
    [[nodiscard]] Result<ShaderCode> irradiance_code() const override { return basis_.code("n", 1, 1); }

  private:
    DirectionalLightmap basis_;
    Negative negative_;
};

}  // namespace

void NormalMoments::values(DirectionView block, float* rows) const {
    // Rows of 1, y, z, x as irradiances; then move them to where they belong.
    HorizonIrradiance(4).values(block, rows + k_block_size);
    float* const one = rows;
    float* const z = rows + k_block_size;
    float* const of_y = rows + 2 * k_block_size;
    float* const of_z = rows + 3 * k_block_size;
    float* const of_x = rows + 4 * k_block_size;
    for (std::size_t j = 0; j < block.size; ++j) {
        one[j] = 1;
        z[j] = block.channel(2)[j];
        const float y = of_y[j], up = of_z[j];
        of_y[j] = of_x[j];
        of_z[j] = y;
        of_x[j] = up;
    }
}

Matrix NormalMoments::gram() const {
    static const Matrix gram = inner_products(*this, *this, product_rule(Domain::hemisphere, 24));
    return gram;
}

std::vector<double> NormalMoments::integrals() const {
    // The first function is 1.
    const Matrix products = gram();
    return {products.begin(), products.begin() + static_cast<std::ptrdiff_t>(size())};
}

Basis::Rotated NormalMoments::rotated(const Rotation&, std::span<const Rgb> c) const {
    return {std::make_shared<NormalMoments>(), {c.begin(), c.end()}};
}

Result<std::shared_ptr<const Basis>> DirectionalLightmap::from_name(std::string_view name) {
    for (const auto& [kind, known] : k_kinds)
        if (name == known) return std::shared_ptr<const Basis>(std::make_shared<DirectionalLightmap>(kind));
    return std::shared_ptr<const Basis>();
}

std::string DirectionalLightmap::name() const { return k_kinds[static_cast<std::size_t>(kind_)].second; }

std::shared_ptr<const LinearBasis> DirectionalLightmap::accumulated() const {
    if (kind_ == Kind::sh1h) return std::make_shared<HemispherePolynomials>(4);
    return std::make_shared<NormalMoments>();
}

std::vector<Meaning> DirectionalLightmap::meanings() const {
    std::vector<Meaning> result(size(), Meaning::light);
    if (kind_ == Kind::enlighten || kind_ == Kind::enlighten_rgb)
        std::fill(result.begin() + 1, result.end(), Meaning::shape);
    return result;
}

void DirectionalLightmap::fit(std::span<const Rgb> accumulated, std::span<Rgb> c) const {
    check_equal("accumulated coefficients", accumulated.size(), kind_ == Kind::sh1h ? 4 : 5);
    check_equal("coefficients", c.size(), size());
    if (kind_ == Kind::sh1h) return fit_dark_below(accumulated, c);
    const auto moments = moments_from(accumulated);
    std::array<LinearIrradiance, 3> e;
    for (std::size_t k = 0; k < 3; ++k) e[k] = constrained(moments[k]);
    const auto of_luminance = directionality(luminance_of(e));
    for (std::size_t k = 0; k < 3; ++k) {
        if (kind_ == Kind::irradz) {
            set_channel(c[0], k, e[k].constant / k_constant_factor);
            for (std::size_t i = 0; i < 3; ++i) set_channel(c[1 + i], k, e[k].slope[(i + 1) % 3] / k_slope_factor);
        } else {
            const auto d = kind_ == Kind::enlighten ? of_luminance : directionality(e[k]);
            set_channel(c[0], k, moments[k][1]);
            for (std::size_t i = 0; i < 3; ++i)
                set_channel(kind_ == Kind::enlighten ? c[1] : c[1 + i], kind_ == Kind::enlighten ? i : k, d[i]);
        }
    }
}

std::array<LinearIrradiance, 3> DirectionalLightmap::irradiance(std::span<const Rgb> c) const {
    std::array<LinearIrradiance, 3> e;
    for (std::size_t k = 0; k < 3; ++k) {
        if (kind_ == Kind::sh1h || kind_ == Kind::irradz) {
            e[k].constant = k_constant_factor * channel_of(c[0], k);
            for (std::size_t i = 0; i < 3; ++i) e[k].slope[(i + 1) % 3] = k_slope_factor * channel_of(c[1 + i], k);
        } else {
            const auto d = [&](std::size_t i) {
                return kind_ == Kind::enlighten ? channel_of(c[1], i) : channel_of(c[1 + i], k);
            };
            e[k].constant = channel_of(c[0], k) / std::max(1e-4, 1.0 + d(2));
            for (std::size_t i = 0; i < 3; ++i) e[k].slope[i] = e[k].constant * d(i);
        }
    }
    return e;
}

void DirectionalLightmap::radiance(std::span<const Rgb> c, DirectionView directions, MutableColourView out) const {
    // The radiance of degree 1 whose irradiance this is: E = pi R0 + 2 pi / 3 R1 . n for L = R0 + R1 . w.
    check_evaluation(size(), c, directions, out);
    std::array<ZonalQuadratic, 3> functions;
    const auto e = irradiance(c);
    const auto slope = [](double of_irradiance) { return static_cast<float>(of_irradiance * 3 / (2 * k_pi)); };
    for (std::size_t k = 0; k < 3; ++k)
        functions[k] = {static_cast<float>(e[k].constant / k_pi),
                        {slope(e[k].slope[0]), slope(e[k].slope[1]), slope(e[k].slope[2])}};
    evaluate(functions, directions, out);
}

ShaderCode DirectionalLightmap::code(const std::string& direction, double constant, double slope) const {
    using shader_text::filled, shader_text::literal;
    // constant + slope along
    const std::string linear =
        literal(constant) + " + " + (slope == 1 ? "along" : filled("$0 * along", {literal(slope)}));
    switch (kind_) {
        case Kind::sh1h:
        case Kind::irradz:
            return {{},
                    filled(R"(    // Degree-1 harmonics ($1).
    vec3 along = light.c[3] * $0.x + light.c[1] * $0.y + light.c[2] * $0.z;
)",
                           {direction, kind_ == Kind::sh1h ? "Ramamoorthi and Hanrahan 2001" : "Roughton et al. 2024"}),
                    filled("$0 * light.c[0] + $1 * along",
                           {literal(constant * k_constant_factor), literal(slope * k_slope_factor)})};
        case Kind::enlighten:
            return {
                {},
                filled(
                    R"(    // Irradiance at (0, 0, 1), and a direction D (Geomerics 2014): E(n) = E (1 + n . D) / (1 + D.z).
    float along = dot(light.c[1], $0);
)",
                    {direction}),
                filled("light.c[0] * (($0) / max(1.0 + light.c[1].z, 1.0e-4))", {linear})};
        case Kind::enlighten_rgb:
            return {{},
                    filled(R"(    // Irradiance at (0, 0, 1), and a direction D (Geomerics 2014) for each channel:
    // E(n) = E (1 + n . D) / (1 + D.z).
    vec3 along = light.c[1] * $0.x + light.c[2] * $0.y + light.c[3] * $0.z;
)",
                           {direction}),
                    filled("light.c[0] * ($0) / max(1.0 + light.c[3], vec3(1.0e-4))", {linear})};
    }
    return {};
}

std::string DirectionalLightmap::description() const {
    switch (kind_) {
        case Kind::sh1h:
            return "degree-1 harmonics of the light above the surface, black below";
        case Kind::irradz:
            return "degree-1 harmonics with exact irradiance at the surface's normal";
        case Kind::enlighten:
            return "irradiance at the surface's normal and a direction";
        case Kind::enlighten_rgb:
            return "irradiance at the surface's normal and a direction for each channel";
    }
    return {};
}

std::shared_ptr<const Evaluator> DirectionalLightmap::evaluator(std::string_view name) const {
    if (name == "linear") return std::make_shared<LinearInNormal>(kind_, Negative::clamped);
    if (name == "linear-signed") return std::make_shared<LinearInNormal>(kind_, Negative::kept);
    return nullptr;
}

std::vector<float> DirectionalLightmap::lead_bounds() const {
    if (kind_ != Kind::sh1h) return {};
    const float degree_1 = std::sqrt(3.0f);
    return {1, degree_1, degree_1, degree_1};
}

Basis::Rotated DirectionalLightmap::rotated(const Rotation& r, std::span<const Rgb> c) const {
    check_equal("coefficients", c.size(), size());
    std::vector<Rgb> turned(c.begin(), c.end());
    if (kind_ == Kind::enlighten) {
        const Vec3 d = rotate(r, {c[1].r, c[1].g, c[1].b});
        turned[1] = {d.x, d.y, d.z};
    } else {
        // x, y, z of harmonics are coefficients 3, 1, 2, those of directions 1, 2, 3.
        const bool harmonic = kind_ == Kind::sh1h || kind_ == Kind::irradz;
        const std::size_t place[] = {harmonic ? 3u : 1u, harmonic ? 1u : 2u, harmonic ? 2u : 3u};
        const float rows[3][3] = {{r[0].x, r[0].y, r[0].z}, {r[1].x, r[1].y, r[1].z}, {r[2].x, r[2].y, r[2].z}};
        for (std::size_t i = 0; i < 3; ++i)
            turned[place[i]] = c[place[0]] * rows[i][0] + c[place[1]] * rows[i][1] + c[place[2]] * rows[i][2];
    }
    return {std::make_shared<DirectionalLightmap>(kind_), std::move(turned)};
}

}  // namespace lobelia
