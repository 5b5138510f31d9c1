// The study of glossy reflection: every reading against rays.
#include "lobelia/bases/specular_study.h"

#include "lobelia/bases/sg_specular.h"
#include "lobelia/bases/spherical_harmonics.h"
#include "lobelia/quadrature.h"

namespace lobelia {
namespace {

constexpr std::array k_study_alphas = {.1f, .25f, .5f, .8f};
constexpr std::array k_study_cosines = {.95f, .6f, .25f};
constexpr std::array k_study_sharpnesses = {.5f, 2.f, 6.f, 16.f, 64.f, 256.f};
/// Of these the published means are made.
constexpr float k_published_low = 2, k_published_high = 64;
constexpr std::size_t k_truth_rays = 4096, k_axes = 400;

/// What a lobe sends to the viewer, by rays.
float by_rays(const std::vector<ggx::Ray>& rays, const gaussian::Lobe& lobe) {
    float sum = 0;
    for (const auto& ray : rays) sum += ray.weight * std::exp(lobe.sharpness * (dot(ray.direction, lobe.axis) - 1));
    return sum;
}

/// One way to read a lobe: a formula or a few rays.
struct Reading {
    std::string name;
    std::optional<SgSpecular> formula;
    std::size_t rays = 0;
};
std::vector<Reading> study_readings() {
    std::vector<Reading> all;
    for (const auto& info : sg_specular_list()) all.push_back({std::string(info.name), info.kind});
    for (std::size_t count : {16u, 64u}) all.push_back({"sampled, " + std::to_string(count) + " rays", {}, count});
    return all;
}

/// Relative errors of one reading: root mean square over axes of the lobe, over that of the truth.
struct RelativeError {
    double sphere = 0, hemisphere = 0;  ///< axes everywhere, or above the horizon
};
struct StudyCase {
    float alpha, cosine, sharpness;
    std::vector<RelativeError> errors;  ///< of each reading
    [[nodiscard]] bool is_published() const { return sharpness >= k_published_low && sharpness <= k_published_high; }
};

std::vector<RelativeError> measure(const ggx::View& view, float sharpness, const std::vector<ggx::Ray>& truth_rays) {
    static const Directions axes = uniform_directions(Domain::sphere, Sequence::hammersley, k_axes, 0);
    std::vector<float> truth;
    double whole = 0, upper = 0;
    for (std::size_t i = 0; i < k_axes; ++i) {
        const Vec3 axis = direction_at(axes, i);
        truth.push_back(by_rays(truth_rays, {axis, sharpness}));
        const double square = static_cast<double>(truth[i] * truth[i]);
        whole += square;
        if (axis.z > 0) upper += square;
    }
    std::vector<RelativeError> errors;
    for (const Reading& reading : study_readings()) {
        const auto few = reading.formula ? std::vector<ggx::Ray>() : ggx::rays(view, reading.rays);
        RelativeError e;
        for (std::size_t i = 0; i < k_axes; ++i) {
            const gaussian::Lobe lobe{direction_at(axes, i), sharpness};
            const float value = reading.formula ? sg_specular(*reading.formula, lobe, view) : by_rays(few, lobe);
            const double square = static_cast<double>((value - truth[i]) * (value - truth[i]));
            e.sphere += square;
            if (lobe.axis.z > 0) e.hemisphere += square;
        }
        errors.push_back({std::sqrt(e.sphere / whole), std::sqrt(e.hemisphere / upper)});
    }
    return errors;
}

std::vector<StudyCase> all_cases() {
    std::vector<StudyCase> cases;
    for (float alpha : k_study_alphas)
        for (float cosine : k_study_cosines) {
            const auto view = ggx::make_view(cosine, alpha);
            const auto rays = ggx::rays(view, k_truth_rays);
            for (float sharpness : k_study_sharpnesses)
                cases.push_back({alpha, cosine, sharpness, measure(view, sharpness, rays)});
        }
    return cases;
}

Study::Table mean_table(const std::vector<StudyCase>& cases) {
    Study::Table table{"Mean relative error of a lobe's reflected light",
                       "Over alpha 0.1, 0.25, 0.5, 0.8; n.v 0.95, 0.6, 0.25; sharpness 2, 6, 16, 64. Each error is a "
                       "root mean square over axes of the lobe, all over the sphere or above the horizon, divided by "
                       "the root mean square of the truth (4096 rays).",
                       {"reading", "axes over the sphere", "axes above the horizon", "worst case, sphere"},
                       {}};
    const auto readings = study_readings();
    for (std::size_t k = 0; k < readings.size(); ++k) {
        double sphere = 0, hemisphere = 0, worst = 0, count = 0;
        for (const auto& one : cases) {
            if (!one.is_published()) continue;
            sphere += one.errors[k].sphere;
            hemisphere += one.errors[k].hemisphere;
            worst = std::max(worst, one.errors[k].sphere);
            ++count;
        }
        table.rows.push_back({readings[k].name, table_number(sphere / count, 3), table_number(hemisphere / count, 3),
                              table_number(worst, 3)});
    }
    return table;
}

Study::Table case_table(const std::vector<StudyCase>& cases, std::size_t k) {
    Study::Table table{"Relative error of " + study_readings()[k].name, "Axes over the sphere.", {"alpha", "n.v"}, {}};
    for (float sharpness : k_study_sharpnesses)
        table.columns.push_back("sharpness " + table_number(static_cast<double>(sharpness), 3));
    for (std::size_t i = 0; i < cases.size(); i += k_study_sharpnesses.size()) {
        std::vector<std::string> row = {table_number(static_cast<double>(cases[i].alpha)),
                                        table_number(static_cast<double>(cases[i].cosine))};
        for (std::size_t j = 0; j < k_study_sharpnesses.size(); ++j)
            row.push_back(table_number(cases[i + j].errors[k].sphere));
        table.rows.push_back(row);
    }
    return table;
}

Study::Table furnace_table() {
    Study::Table table{
        "White furnace: what is reflected of a constant radiance of 1, without Fresnel",
        "In brackets the part that Schlick's power takes, so that F0 reflects F0 (A - B) + B. 4096 rays; "
        "what is missing to 1 left the surface after more than one reflection.",
        {"alpha"},
        {}};
    const std::array cosines = {1.f, .95f, .6f, .25f, .1f};
    for (float cosine : cosines) table.columns.push_back("n.v " + table_number(static_cast<double>(cosine)));
    for (float alpha : {.05f, .1f, .25f, .5f, .8f, 1.f}) {
        std::vector<std::string> row = {table_number(static_cast<double>(alpha))};
        for (float cosine : cosines) {
            const auto lobe = ggx::lobe_by_rays(ggx::make_view(cosine, alpha), k_truth_rays);
            row.push_back(table_number(static_cast<double>(lobe.albedo), 3) + " (" +
                          table_number(static_cast<double>(lobe.fresnel), 2) + ")");
        }
        table.rows.push_back(row);
    }
    return table;
}

/// Points over the sphere, each seen at one angle from one side or another.
struct StudyPoints {
    Directions normals, views;
    std::vector<float> alphas;
    StudyPoints(std::size_t count, float cosine, float alpha) : normals(count), views(count), alphas(count, alpha) {
        const Directions all = uniform_directions(Domain::sphere, Sequence::sobol, count, 4);
        const float sine = std::sqrt(1 - cosine * cosine);
        for (std::size_t i = 0; i < count; ++i) {
            const auto frame = ggx::make_view(direction_at(all, i), direction_at(all, (i + 1) % count), alpha);
            set_entry(normals, i, frame.z);
            set_entry(views, i, normalize(frame.to_world({sine, 0, cosine})));
        }
    }
    [[nodiscard]] SpecularPoints view() const { return {normals, views, alphas}; }
};

/// The harmonics of ((1 + z) / 2)^degree, which is nowhere negative.
std::vector<Rgb> power_of_height(std::size_t degree) {
    const auto rule = product_rule(Domain::sphere, degree + 1);
    std::vector<Rgb> c(harmonics::coefficient_count(degree));
    for (std::size_t q = 0; q < rule.weights.size(); ++q) {
        const Vec3 d = direction_at(rule.directions, q);
        const auto y = harmonics::values(degree, d.x, d.y, d.z);
        const double light = std::pow((1 + static_cast<double>(d.z)) / 2, static_cast<double>(degree));
        for (std::size_t i = 0; i < c.size(); ++i)
            c[i] = c[i] + Rgb{1, 1, 1} * static_cast<float>(rule.weights[q] * light * y[i]);
    }
    return c;
}

double harmonic_error(const SpecularEvaluator& evaluator, const SpecularEvaluator& truth, std::span<const Rgb> c,
                      const StudyPoints& points) {
    Colours out(points.alphas.size()), exact(points.alphas.size());
    evaluator.reflected(c, points.view(), out);
    truth.reflected(c, points.view(), exact);
    double error = 0, whole = 0;
    for (std::size_t i = 0; i < out.size(); ++i) {
        const auto e = static_cast<double>(colour_at(exact, i).g), d = static_cast<double>(colour_at(out, i).g) - e;
        error += d * d;
        whole += e * e;
    }
    return std::sqrt(error / whole);
}

Study::Table harmonics_table() {
    Study::Table table{"Relative error of spherical harmonics",
                       "Light ((1 + cos) / 2)^L, of degree L exactly; root mean square over 100 normals on the sphere, "
                       "over that of 1024 rays on the same harmonics.",
                       {"alpha", "n.v", "L"},
                       {}};
    for (const auto& name : sh_specular_names()) table.columns.push_back(name);
    for (float alpha : k_study_alphas)
        for (float cosine : k_study_cosines)
            for (std::size_t degree : {1u, 2u, 4u, 8u}) {
                const auto basis = std::make_shared<SphericalHarmonics>(degree);
                const auto truth = make_sampled_specular(basis, 1024);
                const auto c = power_of_height(degree);
                const StudyPoints points(100, cosine, alpha);
                std::vector<std::string> row = {table_number(static_cast<double>(alpha)),
                                                table_number(static_cast<double>(cosine)), std::to_string(degree)};
                for (const auto& name : sh_specular_names())
                    row.push_back(table_number(harmonic_error(*basis->specular(name), *truth, c, points)));
                table.rows.push_back(row);
            }
    return table;
}

Study::Plot sharpness_plot(const std::vector<StudyCase>& cases) {
    Study::Plot plot{"Error against sharpness",
                     "Relative error of a lobe's reflected light, mean over the alphas and angles of the tables.",
                     "sharpness",
                     "relative error",
                     Study::Axis::logarithmic,
                     Study::Axis::logarithmic,
                     {}};
    const auto readings = study_readings();
    for (std::size_t k = 0; k < readings.size(); ++k) {
        Study::Series series{readings[k].name, {}, {}};
        for (std::size_t j = 0; j < k_study_sharpnesses.size(); ++j) {
            double sum = 0, count = 0;
            for (std::size_t i = j; i < cases.size(); i += k_study_sharpnesses.size(), ++count)
                sum += cases[i].errors[k].sphere;
            series.x.push_back(static_cast<double>(k_study_sharpnesses[j]));
            series.y.push_back(sum / count);
        }
        plot.series.push_back(std::move(series));
    }
    return plot;
}

/// Reflected light while a lobe goes round in the plane of incidence.
Study::Plot curve_plot(float alpha, float cosine, float sharpness) {
    const auto text = [](float value) { return table_number(static_cast<double>(value)); };
    Study::Plot plot{"alpha " + text(alpha) + ", n.v " + text(cosine) + ", sharpness " + text(sharpness),
                     "A lobe goes round in the plane of incidence; its angle from the normal is positive on the side "
                     "away from the viewer.",
                     "angle of the lobe [degrees]",
                     "reflected light",
                     Study::Axis::linear,
                     Study::Axis::linear,
                     {}};
    const auto view = ggx::make_view(cosine, alpha);
    const auto rays = ggx::rays(view, k_truth_rays);
    Study::Series truth{"4096 rays", {}, {}};
    const auto lobe_at = [&](int degrees) {
        const double angle = degrees * k_pi / 180;
        return gaussian::Lobe{{static_cast<float>(-std::sin(angle)), 0, static_cast<float>(std::cos(angle))},
                              sharpness};
    };
    for (int degrees = -120; degrees <= 150; degrees += 2) {
        truth.x.push_back(degrees);
        truth.y.push_back(static_cast<double>(by_rays(rays, lobe_at(degrees))));
    }
    for (const auto& info : sg_specular_list()) {
        Study::Series series{std::string(info.name), truth.x, {}};
        for (double x : truth.x)
            series.y.push_back(static_cast<double>(sg_specular(info.kind, lobe_at(static_cast<int>(x)), view)));
        plot.series.push_back(std::move(series));
    }
    plot.series.push_back(std::move(truth));
    return plot;
}

/// A glossy sphere seen from +z; `reflect(view, axis)` gives what it reflects of the lobe, whose axis is in the view's
/// frame; divided by `brightest`.
template <class Reflect>
Image glossy_sphere(float alpha, float brightest, const Reflect& reflect) {
    constexpr std::size_t size = 128, subsamples = 2, across = size * subsamples;
    const Vec3 axis = normalize(Vec3{-0.5f, 0.6f, 0.62f});
    Image image(size, size);
    for (std::size_t i = 0; i < across * across; ++i) {
        const std::size_t x = i % across, y = i / across;
        const float u = 1.08f * ((static_cast<float>(x) + 0.5f) / (0.5f * across) - 1);
        const float v = 1.08f * (1 - (static_cast<float>(y) + 0.5f) / (0.5f * across));
        const float squared = u * u + v * v;
        if (squared > 1) continue;
        const auto view = ggx::make_view({u, v, std::sqrt(1 - squared)}, {0, 0, 1}, alpha);
        const float value = reflect(view, view.to_local(axis)) / (brightest * subsamples * subsamples);
        Rgb& pixel = image.pixels[(y / subsamples) * size + x / subsamples];
        pixel = pixel + Rgb{value, value, value};
    }
    return image;
}

void add_glossy_spheres(Study& study, float alpha, float sharpness) {
    const auto caption = "alpha " + table_number(static_cast<double>(alpha)) + ", sharpness " +
                         table_number(static_cast<double>(sharpness));
    // A lobe in the mirror direction of a view from half way up.
    const auto facing = ggx::make_view(0.7f, alpha);
    const float brightest = by_rays(ggx::rays(facing, 512), {{-facing.sine, 0, facing.cosine}, sharpness});
    study.pictures.push_back({"512 rays", caption, glossy_sphere(alpha, brightest, [&](const auto& view, Vec3 axis) {
                                  return by_rays(ggx::rays(view, 512), {axis, sharpness});
                              })});
    for (const auto& info : sg_specular_list()) {
        // The view in its own frame, which the axis is in.
        const auto reflect = [&](const ggx::View& view, Vec3 axis) {
            return sg_specular(info.kind, {axis, sharpness}, ggx::make_view(view.cosine, alpha));
        };
        study.pictures.push_back({std::string(info.name), caption, glossy_sphere(alpha, brightest, reflect)});
    }
}

}  // namespace

Study study_specular() {
    Study study;
    study.name = "specular";
    study.title = "Glossy reflection of lobes and harmonics";
    study.summary =
        "A lobe exp(lambda (l.p - 1)) lights a GGX surface: the reflected radiance is the integral of the lobe times "
        "D G / (4 n.v) over the hemisphere, without Fresnel. Each reading is compared with rays along visible normals, "
        "over roughness, view angle and sharpness; spherical harmonics likewise.";
    const auto cases = all_cases();
    study.tables.push_back(mean_table(cases));
    for (std::size_t k = 0; k < sg_specular_list().size(); ++k) study.tables.push_back(case_table(cases, k));
    study.tables.push_back(harmonics_table());
    study.tables.push_back(furnace_table());
    study.plots.push_back(sharpness_plot(cases));
    for (const auto& [alpha, cosine, sharpness] :
         {std::array{.1f, .25f, 16.f}, {.25f, .6f, 16.f}, {.5f, .6f, 6.f}, {.8f, .6f, 64.f}})
        study.plots.push_back(curve_plot(alpha, cosine, sharpness));
    for (float alpha : {.1f, .25f, .5f}) add_glossy_spheres(study, alpha, 16);
    return study;
}

}  // namespace lobelia
