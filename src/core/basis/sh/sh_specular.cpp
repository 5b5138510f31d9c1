// Glossy reflection of spherical harmonics.
#include "core/basis/sh/sh_specular.h"

#include "core/basis/sh/sh_shader.h"
#include "core/math/ggx.h"
#include "core/math/harmonics.h"

namespace lobelia {
namespace {

ggx::View glossy_view(const SpecularPoints& points, std::size_t i) {
    return ggx::make_view(direction_at(points.normals, i), direction_at(points.views, i), points.alphas[i]);
}

/// Harmonics in one direction for each point, every band times a factor of the point's.
class ZonalSpecular final : public SpecularEvaluator {
  public:
    enum class Kind { prefiltered, convolution };

    ZonalSpecular(Kind kind, std::size_t degree) : kind_(kind), harmonics_(degree) {
        check_range("degree", degree, 0, ggx::k_zonal_degree);
    }
    [[nodiscard]] std::string name() const override {
        return kind_ == Kind::convolution ? "sh-convolution" : "sh-prefiltered";
    }
    [[nodiscard]] Accuracy accuracy() const override {
        return {k_range, kind_ == Kind::convolution ? k_convolution_error : k_prefiltered_error, Reading::of_radiance,
                0.005};
    }
    [[nodiscard]] Result<ShaderCode> reflected_code() const override {
        const std::size_t degree = harmonics_.degree();
        return kind_ == Kind::convolution ? sh_shader::convolved(degree) : sh_shader::prefiltered(degree);
    }
    void reflected(std::span<const Rgb> c, const SpecularPoints& points, MutableColourView out) const override {
        check_specular(harmonics_.size(), c, points, out);
        std::vector<float> rows(harmonics_.size() * k_block_size);
        Directions directions(k_block_size);
        std::vector<Read> reads(k_block_size);
        for (std::size_t begin = 0; begin < points.size(); begin += k_block_size) {
            const std::size_t count = std::min(k_block_size, points.size() - begin);
            for (std::size_t j = 0; j < count; ++j) {
                reads[j] = read(glossy_view(points, begin + j));
                set_entry(directions, j, reads[j].direction);
            }
            harmonics_.values(DirectionView(directions).part(0, count), rows.data());
            for (std::size_t j = 0; j < count; ++j) set_entry(out, begin + j, sum(c, reads[j], rows.data() + j));
        }
    }

  private:
    // Root mean square over points, over that of the reference, for a lobe of degrees 2 to 8.
    static constexpr const char* k_range = "alpha 0.1 to 0.8, n.v 0.25 to 1";
    static constexpr const char* k_convolution_error = "0.13 of the reflected light, RMS; 0 to degree 1";
    static constexpr const char* k_prefiltered_error = "0.7 of the reflected light, RMS; 0 for degree 0";

    struct Read {
        Vec3 direction;
        float albedo = 0;
        std::array<float, ggx::k_zonal_degree + 1> bands{};
    };
    [[nodiscard]] Read read(const ggx::View& view) const {
        const ggx::Lobe lobe = ggx::lobe(view);
        if (kind_ == Kind::convolution) return {normalize(view.to_world(lobe.axis)), lobe.albedo, lobe.zonal};
        const ggx::Lobe along_normal = ggx::lobe(ggx::make_view(1, view.alpha));
        return {normalize(view.to_world({-view.sine, 0, view.cosine})), lobe.albedo, along_normal.zonal};
    }
    [[nodiscard]] Rgb sum(std::span<const Rgb> c, const Read& at, const float* values) const {
        Rgb total;
        for (std::size_t l = 0, i = 0; l <= harmonics_.degree(); ++l) {
            Rgb band;
            for (; i < harmonics::coefficient_count(l); ++i) band = band + c[i] * values[i * k_block_size];
            total = total + band * at.bands[l];
        }
        total = total * at.albedo;
        return {std::max(0.0f, total.r), std::max(0.0f, total.g), std::max(0.0f, total.b)};
    }

    Kind kind_;
    harmonics::Harmonics harmonics_;
};

/// Degree 1 as ambient light and a lamp.
class DominantSpecular final : public SpecularEvaluator {
  public:
    explicit DominantSpecular(std::size_t degree) : coefficients_(harmonics::coefficient_count(degree)) {}
    [[nodiscard]] std::string name() const override { return "sh-dominant"; }
    [[nodiscard]] Accuracy accuracy() const override {
        return {"any alpha and view", "exact for constant light and for one lamp", Reading::of_its_own, 0.005};
    }
    [[nodiscard]] Result<ShaderCode> reflected_code() const override { return sh_shader::dominant(); }
    void reflected(std::span<const Rgb> c, const SpecularPoints& points, MutableColourView out) const override {
        check_specular(coefficients_, c, points, out);
        const Light light = split(c);
        for (std::size_t i = 0; i < points.size(); ++i) {
            ggx::View view = glossy_view(points, i);
            Rgb L = light.ambient * ggx::lobe(view).albedo;
            // The lamp's width is unknown but for how far light points at all: make the surface rougher instead.
            view.alpha = std::min(1.0f, view.alpha / std::max(light.pointing, 1e-4f));
            L = L + light.lamp * static_cast<float>(ggx::reflection_from(view, light.direction));
            set_entry(out, i, L);
        }
    }

  private:
    struct Light {
        Vec3 direction{0, 0, 1};
        float pointing = 0;  ///< length of the mean direction of light, 0 to 1
        Rgb lamp, ambient;   ///< irradiance across the lamp's beam, and radiance
    };
    static Light split(std::span<const Rgb> c) {
        // The integrals of L and of w L.
        const float whole = std::sqrt(4 * static_cast<float>(k_pi)), linear = whole / std::sqrt(3.0f);
        const Rgb sum = c[0] * whole;
        const Rgb along[] = {c[3] * linear, c[1] * linear, c[2] * linear};
        const Vec3 mean{luminance(along[0]), luminance(along[1]), luminance(along[2])};
        const float size = length(mean), total = luminance(sum);
        Light light;
        if (!(size > 0) || !(total > 0)) {
            light.ambient = sum * (1 / (4 * static_cast<float>(k_pi)));
            return light;
        }
        light.direction = mean * (1 / size);
        light.pointing = std::min(1.0f, size / total);
        const Rgb beam = along[0] * light.direction.x + along[1] * light.direction.y + along[2] * light.direction.z;
        const auto cut = [](float value, float most) { return std::clamp(value, 0.0f, std::max(0.0f, most)); };
        light.lamp = {cut(beam.r, sum.r), cut(beam.g, sum.g), cut(beam.b, sum.b)};
        light.ambient = (sum - light.lamp) * (1 / (4 * static_cast<float>(k_pi)));
        return light;
    }

    std::size_t coefficients_;
};

}  // namespace

std::vector<std::string> sh_specular_names() { return {"sh-dominant", "sh-prefiltered", "sh-convolution"}; }

std::shared_ptr<const SpecularEvaluator> sh_specular(std::string_view name, std::size_t degree) {
    if (name == "sh-dominant") return std::make_shared<DominantSpecular>(degree);
    if (name == "sh-prefiltered") return std::make_shared<ZonalSpecular>(ZonalSpecular::Kind::prefiltered, degree);
    if (name == "sh-convolution") return std::make_shared<ZonalSpecular>(ZonalSpecular::Kind::convolution, degree);
    return nullptr;
}

}  // namespace lobelia
