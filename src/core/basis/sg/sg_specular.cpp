// Glossy reflection of spherical Gaussians: what is the same for all views once a lobe, what is the same for all lobes
// once a view.
#include "core/basis/sg/sg_specular.h"

#include <array>

#include "core/basis/sg/sg_specular_lanes.h"
#include "core/basis/sg/sg_specular_shader.h"
#include "core/math/number_text.h"

namespace lobelia {

namespace {

SgLight make_light(const gaussian::Lobe& lobe) {
    const double s = lobe.sharpness, mean = gaussian::mean_cosine(s);
    const double spread = s < 1 ? 1 - mean : 1 / s - 2 / std::expm1(2 * s);
    return {lobe.axis,
            lobe.sharpness,
            static_cast<float>(gaussian::integral(s)),
            static_cast<float>(mean),
            static_cast<float>(spread),
            std::pow(lobe.sharpness, k_gloss_steepness)};
}

void set_view(const ggx::View& v, float* column) {
    const auto put = [&](std::size_t row, float value) { column[row * k_block_size] = value; };
    const ggx::Lobe lobe = ggx::lobe(v);
    const Vec3 frame[] = {v.x, v.y, v.z};
    for (std::size_t i = 0; i < 3; ++i) {
        put(k_row_frame + 3 * i, frame[i].x);
        put(k_row_frame + 3 * i + 1, frame[i].y);
        put(k_row_frame + 3 * i + 2, frame[i].z);
    }
    put(k_row_viewer, v.viewer.x);
    put(k_row_viewer + 1, v.viewer.y);
    put(k_row_viewer + 2, v.viewer.z);
    const float alpha2 = v.alpha * v.alpha;
    const float masked = 1 + static_cast<float>(ggx::smith(static_cast<double>(v.alpha), v.direction()));
    put(k_row_sine, v.sine);
    put(k_row_cosine, v.cosine);
    put(k_row_alpha2, alpha2);
    put(k_row_peak, 1 / (static_cast<float>(k_pi) * alpha2 * 4 * v.cosine * (2 * masked - 1)));
    put(k_row_masked, masked);
    // The Gaussian of this spread (Banerjee et al. 2005; within 4 %).
    const float r = 1 - lobe.spread, sharpness = r * (3 - r * r) / (std::max(lobe.spread, 1e-12f) * (1 + r));
    put(k_row_middle, std::pow(k_gloss_middle * sharpness * std::pow(v.cosine, k_gloss_grazing), -k_gloss_steepness));
    put(k_row_axis_x, lobe.axis.x);
    put(k_row_axis_z, lobe.axis.z);
    put(k_row_spread, lobe.spread);
    put(k_row_albedo, lobe.albedo);
}

constexpr std::array k_sg_speculars = {
    SgSpecularInfo{SgSpecular::punctual, "punctual", 6.6},
    SgSpecularInfo{SgSpecular::sg_warp, "sg-warp", 0.82},
    SgSpecularInfo{SgSpecular::asg_warp, "asg-warp", 0.87},
    SgSpecularInfo{SgSpecular::tokuyoshi_2024, "tokuyoshi-2024", 0.42},
    SgSpecularInfo{SgSpecular::moments, "moments", 0.62},
    SgSpecularInfo{SgSpecular::masked, "masked", 0.33},
    SgSpecularInfo{SgSpecular::two_ends, "two-ends", 0.155},
};

class SgSpecularSum final : public SpecularEvaluator {
  public:
    SgSpecularSum(const SgSpecularInfo& info, const std::vector<gaussian::Lobe>& lobes) : info_(info) {
        for (const auto& lobe : lobes) lights_.push_back(make_light(lobe));
    }
    [[nodiscard]] std::string name() const override { return std::string(info_.name); }
    [[nodiscard]] Accuracy accuracy() const override {
        return {"alpha 0.1 to 0.8, n.v 0.25 to 1, sharpness 2 to 64",
                table_number(info_.error) + " of a lobe's reflected light, RMS over its axes", Reading::of_radiance, 0};
    }
    [[nodiscard]] Result<ShaderCode> reflected_code() const override {
        return sg_shader::reflected(info_.kind, lights_);
    }
    void reflected(std::span<const Rgb> c, const SpecularPoints& points, MutableColourView out) const override {
        check_specular(lights_.size(), c, points, out);
        std::vector<float> rows(k_view_rows * k_block_size);
        for (std::size_t begin = 0; begin < points.size(); begin += k_block_size) {
            const std::size_t count = std::min(k_block_size, points.size() - begin);
            for (std::size_t j = 0; j < count; ++j)
                set_view(ggx::make_view(direction_at(points.normals, begin + j), direction_at(points.views, begin + j),
                                        points.alphas[begin + j]),
                         rows.data() + j);
            reflect_lobes(info_.kind, rows.data(), lights_, c, out.part(begin, count));
        }
    }

  private:
    const SgSpecularInfo& info_;
    std::vector<SgLight> lights_;
};

}  // namespace

std::span<const SgSpecularInfo> sg_specular_list() { return k_sg_speculars; }

std::optional<SgSpecular> sg_specular_from_name(std::string_view name) {
    for (const auto& entry : k_sg_speculars)
        if (entry.name == name) return entry.kind;
    return std::nullopt;
}

std::vector<float> sg_specular(SgSpecular kind, const ggx::View& view, float sharpness, DirectionView axes) {
    // Turn the view instead of the lobe, to a frame in which the axis is z.
    std::vector<float> rows(k_view_rows * k_block_size), values(axes.size);
    const SgLight light = make_light({{0, 0, 1}, sharpness});
    const Rgb one{1, 1, 1};
    Colours out(k_block_size);
    for_each_part(axes, k_block_size, [&](DirectionView part, std::size_t begin) {
        for (std::size_t j = 0; j < part.size; ++j) {
            const ggx::View about_axis = ggx::make_view(direction_at(part, j), view.direction(), 1);
            ggx::View turned = view;
            turned.x = about_axis.to_local({1, 0, 0});
            turned.y = about_axis.to_local({0, 1, 0});
            turned.z = about_axis.to_local({0, 0, 1});
            turned.viewer = about_axis.to_local(view.direction());
            set_view(turned, rows.data() + j);
        }
        reflect_lobes(kind, rows.data(), {&light, 1}, {&one, 1}, MutableColourView(out).part(0, part.size));
        std::copy_n(out.channel(0), part.size, values.data() + begin);
    });
    return values;
}

std::vector<std::string> sg_specular_names() {
    std::vector<std::string> names;
    for (const auto& entry : k_sg_speculars) names.emplace_back(entry.name);
    return names;
}

std::shared_ptr<const SpecularEvaluator> make_sg_specular(std::string_view name, std::vector<gaussian::Lobe> lobes) {
    for (const auto& entry : k_sg_speculars)
        if (entry.name == name) return std::make_shared<SgSpecularSum>(entry, lobes);
    return nullptr;
}

}  // namespace lobelia
