// Glossy reflection: the split sum, and the reading of any basis at sampled directions.
#include "lobelia/specular.h"

#include "core/math/ggx.h"

namespace lobelia {
namespace {

/// The index of a direction has 32 bits.
constexpr std::size_t k_most_directions = std::size_t{1} << 24;

class SampledSpecular final : public SpecularEvaluator {
  public:
    SampledSpecular(std::shared_ptr<const Basis> basis, std::size_t count) : basis_(std::move(basis)), count_(count) {}
    [[nodiscard]] std::string name() const override { return "sampled"; }
    [[nodiscard]] Result<ShaderCode> reflected_code() const override {
        return Error{
            "specular evaluator sampled has no shader code: it evaluates the basis in many directions for each point"};
    }
    [[nodiscard]] Accuracy accuracy() const override {
        return {"any alpha and view", "that of " + std::to_string(count_) + " directions", Reading::of_radiance, 0};
    }
    void reflected(std::span<const Rgb> c, const SpecularPoints& points, MutableColourView out) const override {
        check_specular(basis_->size(), c, points, out);
        Directions directions(count_);
        Colours radiance(count_);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const auto view =
                ggx::make_view(direction_at(points.normals, i), direction_at(points.views, i), points.alphas[i]);
            const auto rays = ggx::rays(view, count_);
            for (std::size_t j = 0; j < rays.size(); ++j)
                set_entry(directions, j, normalize(view.to_world(rays[j].direction)));
            basis_->radiance(c, DirectionView(directions).part(0, rays.size()),
                             MutableColourView(radiance).part(0, rays.size()));
            set_entry(out, i, sum(rays, directions, radiance));
        }
    }

  private:
    [[nodiscard]] Rgb sum(const std::vector<ggx::Ray>& rays, DirectionView directions, ColourView radiance) const {
        Rgb total;
        for (std::size_t j = 0; j < rays.size(); ++j) {
            // A basis over the hemisphere is undefined below the horizon.
            if (basis_->domain() == Domain::hemisphere && directions.channel(2)[j] < 0) continue;
            const Rgb L = colour_at(radiance, j);
            total = total + Rgb{std::max(0.0f, L.r), std::max(0.0f, L.g), std::max(0.0f, L.b)} * rays[j].weight;
        }
        return total;
    }

    std::shared_ptr<const Basis> basis_;
    std::size_t count_;
};

}  // namespace

void specular(const SpecularEvaluator& evaluator, std::span<const Rgb> c, const SpecularPoints& points, Rgb f0,
              MutableColourView out) {
    evaluator.reflected(c, points, out);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto lobe = ggx::lobe(
            ggx::make_view(dot(direction_at(points.normals, i), direction_at(points.views, i)), points.alphas[i]));
        // F = F0 (1 - k) + k: the albedo under it, as a share of that for F = 1.
        const float scale = (lobe.albedo - lobe.fresnel) / lobe.albedo, bias = lobe.fresnel / lobe.albedo;
        const Rgb L = colour_at(out, i);
        set_entry(out, i, Rgb{L.r * (f0.r * scale + bias), L.g * (f0.g * scale + bias), L.b * (f0.b * scale + bias)});
    }
}

Result<ShaderCode> specular_code(const SpecularEvaluator& evaluator) {
    auto code = evaluator.reflected_code();
    if (!code) return code;
    code->statements +=
        "    // Schlick's Fresnel factor by the split sum (Karis 2013): how much of a constant light it reflects.\n"
        "    float fresnel = texels.view_0.y / texels.view_0.x;\n";
    code->result += " * mix(vec3(fresnel), vec3(1.0), f0)";
    return code;
}

SpecularTable ggx_table() { return {ggx::k_table_side, ggx::k_table_side, ggx::k_table_layers, ggx::table_texels()}; }

std::shared_ptr<const SpecularEvaluator> make_sampled_specular(std::shared_ptr<const Basis> basis, std::size_t count) {
    check_range("directions", count, 1, k_most_directions);
    return std::make_shared<SampledSpecular>(std::move(basis), count);
}

}  // namespace lobelia
