// Spherical harmonics as a basis.
#include "lobelia/bases/spherical_harmonics.h"

namespace lobelia {
namespace {

constexpr std::size_t k_highest_degree = 8;

/// Degree 1 by mean and direction, as lightmaps have it: with L0 = c_0 Y_0, the mean radiance, and
/// L1 = (sqrt(3) / 3) (c_3, c_1, c_2) / c_0, whose length is 1 at most where no light is negative,
///
///   E(n) / pi = 2 L0 (1/2 + dot(L1, n)).
///
/// From A_0 = pi, A_1 = 2 pi / 3: E / pi = c_0 Y_0 + (2/3) sqrt(3 / 4pi) (c_3 x + c_1 y + c_2 z), and the second factor
/// over 2 Y_0 is sqrt(3) / 3. The bound: c_0 = Y_0 times the integral of L, and |(c_3, c_1, c_2)| is at most
/// sqrt(3) Y_0 times it. Textures hold L1 / 2 + 1/2.
class RelativeLinearBand final : public TexturePacking {
  public:
    [[nodiscard]] std::string name() const override { return "l1-over-l0"; }
    [[nodiscard]] std::size_t coefficients() const override { return 4; }
    [[nodiscard]] std::string reading() const override {
        return "with L1 = 2 * (x, y, z) - 1 in each colour channel: E(n) / pi = 2 * L0 * (0.5 + dot(L1, n))";
    }
    [[nodiscard]] std::vector<TextureArray> textures() const override {
        return {{"l0", TexelFormat::half, {"L0 = c0 / sqrt(4 pi)"}},
                {"l1",
                 TexelFormat::unorm8,
                 {"x = 0.5 + sqrt(3) / 6 * c3 / c0", "y = 0.5 + sqrt(3) / 6 * c1 / c0",
                  "z = 0.5 + sqrt(3) / 6 * c2 / c0"}}};
    }
    void pack(std::span<const Rgb> c, std::span<Rgb> layers) const override {
        for (float Rgb::*channel : {&Rgb::r, &Rgb::g, &Rgb::b}) {
            // Noise may leave what no light has: negative means, or directions longer than 1.
            const float c0 = c[0].*channel;
            const Vec3 linear{c[3].*channel, c[1].*channel, c[2].*channel};
            const float longest = std::max(length(linear) * k_ratio, c0);
            const Vec3 l1 = c0 > 0 ? linear * (k_ratio / longest) : Vec3{};
            layers[0].*channel = std::max(c0, 0.0f) * k_y0;
            layers[1].*channel = 0.5f + 0.5f * l1.x;
            layers[2].*channel = 0.5f + 0.5f * l1.y;
            layers[3].*channel = 0.5f + 0.5f * l1.z;
        }
    }
    void unpack(std::span<const Rgb> layers, std::span<Rgb> c) const override {
        for (float Rgb::*channel : {&Rgb::r, &Rgb::g, &Rgb::b}) {
            const float c0 = layers[0].*channel / k_y0;
            c[0].*channel = c0;
            c[3].*channel = (2 * layers[1].*channel - 1) * c0 / k_ratio;
            c[1].*channel = (2 * layers[2].*channel - 1) * c0 / k_ratio;
            c[2].*channel = (2 * layers[3].*channel - 1) * c0 / k_ratio;
        }
    }

  private:
    static constexpr float k_y0 = 0.28209479f;     ///< sqrt(1 / 4pi)
    static constexpr float k_ratio = 0.57735027f;  ///< sqrt(3) / 3
};

}  // namespace

Result<std::shared_ptr<const Basis>> SphericalHarmonics::from_name(std::string_view name) {
    if (name.size() != 3 || !name.starts_with("sh") || name[2] < '1' ||
        name[2] > '0' + static_cast<int>(k_highest_degree))
        return std::shared_ptr<const Basis>();
    return std::shared_ptr<const Basis>(std::make_shared<SphericalHarmonics>(static_cast<std::size_t>(name[2] - '0')));
}

std::string SphericalHarmonics::name() const { return "sh" + std::to_string(harmonics_.degree()); }

std::string SphericalHarmonics::description() const {
    return "spherical harmonics of degree " + std::to_string(harmonics_.degree()) + ", " + std::to_string(size()) +
           " coefficients";
}

BasisNotes SphericalHarmonics::notes() const {
    return {"Spherical harmonics",
            "L(w) = sum over l and m of c_lm Y_lm(w), orthonormal and real, all signs plus, index l^2 + l + m",
            "smooth light and its irradiance (degree 2 is off by a few per cent); turning; adding and filtering, since "
            "they are linear and know no axis of their own",
            "small and bright sources: they ring, radiance and irradiance turn negative opposite to the sun"};
}

Matrix SphericalHarmonics::gram() const {
    Matrix identity(size() * size());
    for (std::size_t i = 0; i < size(); ++i) identity[i * size() + i] = 1;
    return identity;
}

std::vector<double> SphericalHarmonics::integrals() const {
    std::vector<double> result(size());
    result[0] = std::sqrt(4 * k_pi);
    return result;
}

std::vector<float> SphericalHarmonics::lead_bounds() const {
    std::vector<float> bounds;
    for (std::size_t l = 0; l <= harmonics_.degree(); ++l)
        bounds.insert(bounds.end(), 2 * l + 1, std::sqrt(static_cast<float>(2 * l + 1)));
    return bounds;
}

std::vector<std::shared_ptr<const TexturePacking>> SphericalHarmonics::packings() const {
    std::vector<std::shared_ptr<const TexturePacking>> all = Basis::packings();
    if (harmonics_.degree() == 1) all.push_back(std::make_shared<RelativeLinearBand>());
    return all;
}

Basis::Rotated SphericalHarmonics::rotated(const Rotation& r, std::span<const Rgb> c) const {
    return {std::make_shared<SphericalHarmonics>(harmonics_.degree()), harmonics::rotated(r, c)};
}

}  // namespace lobelia
