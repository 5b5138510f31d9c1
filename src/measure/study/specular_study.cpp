// The study of specular reflection: every evaluator against rays.
#include "measure/study/specular_study.h"

#include <algorithm>

#include "core/basis/sg/sg_specular.h"
#include "core/basis/sh/spherical_harmonics.h"
#include "core/math/quadrature.h"

namespace lobelia {
namespace {

constexpr std::array k_study_alphas = {.1f, .25f, .5f, .8f};
constexpr std::array k_study_cosines = {.95f, .6f, .25f};
constexpr std::array k_study_sharpnesses = {.5f, 2.f, 6.f, 16.f, 64.f, 256.f};
/// Sharpnesses within this range make the published means.
constexpr float k_published_low = 2, k_published_high = 64;
constexpr std::size_t k_reference_rays = 4096, k_axes = 400;

/// Reflected radiance of a lobe, by rays.
float study_by_rays(const std::vector<ggx::Ray>& rays, float sharpness, Vec3 axis) {
    float sum = 0;
    for (const auto& ray : rays) sum += ray.weight * std::exp(sharpness * (dot(ray.direction, axis) - 1));
    return sum;
}
std::vector<float> study_by_rays(const std::vector<ggx::Ray>& rays, float sharpness, DirectionView axes) {
    std::vector<float> values(axes.size);
    for (std::size_t i = 0; i < axes.size; ++i) values[i] = study_by_rays(rays, sharpness, direction_at(axes, i));
    return values;
}

/// One way to evaluate a lobe: a formula or a few rays.
struct StudyEvaluator {
    std::string name;
    std::optional<SgSpecular> formula;
    std::size_t rays = 0;
};
std::vector<StudyEvaluator> study_evaluators() {
    std::vector<StudyEvaluator> all;
    for (const auto& info : sg_specular_list()) all.push_back({std::string(info.name), info.kind});
    for (std::size_t count : {16u, 64u}) all.push_back({"sampled, " + std::to_string(count) + " rays", {}, count});
    return all;
}

/// Relative errors of one evaluator: root mean square over axes of the lobe, over that of the reference.
struct StudyError {
    double sphere = 0, hemisphere = 0;  ///< axes everywhere, or above the horizon
};
struct StudyCase {
    float alpha, cosine, sharpness;
    std::vector<StudyError> errors;  ///< of each evaluator
    [[nodiscard]] bool is_published() const { return sharpness >= k_published_low && sharpness <= k_published_high; }
};

std::vector<StudyError> measure_specular(const ggx::View& view, float sharpness,
                                         const std::vector<ggx::Ray>& reference_rays) {
    static const Directions axes = uniform_directions(Domain::sphere, Sequence::hammersley, k_axes, 0);
    const auto reference = study_by_rays(reference_rays, sharpness, axes);
    double whole = 0, upper = 0;
    for (std::size_t i = 0; i < k_axes; ++i) {
        const double square = static_cast<double>(reference[i] * reference[i]);
        whole += square;
        if (direction_at(axes, i).z > 0) upper += square;
    }
    std::vector<StudyError> errors;
    for (const StudyEvaluator& evaluator : study_evaluators()) {
        const auto values = evaluator.formula ? sg_specular(*evaluator.formula, view, sharpness, axes)
                                              : study_by_rays(ggx::rays(view, evaluator.rays), sharpness, axes);
        StudyError e;
        for (std::size_t i = 0; i < k_axes; ++i) {
            const double square = static_cast<double>((values[i] - reference[i]) * (values[i] - reference[i]));
            e.sphere += square;
            if (direction_at(axes, i).z > 0) e.hemisphere += square;
        }
        errors.push_back({std::sqrt(e.sphere / whole), std::sqrt(e.hemisphere / upper)});
    }
    return errors;
}

std::vector<StudyCase> all_specular_cases() {
    std::vector<StudyCase> cases;
    for (float alpha : k_study_alphas)
        for (float cosine : k_study_cosines) {
            const auto view = ggx::make_view(cosine, alpha);
            const auto rays = ggx::rays(view, k_reference_rays);
            for (float sharpness : k_study_sharpnesses)
                cases.push_back({alpha, cosine, sharpness, measure_specular(view, sharpness, rays)});
        }
    return cases;
}

Study::Table mean_specular_table(const std::vector<StudyCase>& cases) {
    Study::Table table{"Mean relative error of a lobe's reflected light",
                       "Over alpha 0.1, 0.25, 0.5, 0.8; n.v 0.95, 0.6, 0.25; sharpness 2, 6, 16, 64. Each error is a "
                       "root mean square over axes of the lobe, all over the sphere or above the horizon, divided by "
                       "the root mean square of the reference (4096 rays).",
                       {"evaluator", "axes over the sphere", "axes above the horizon", "worst case, sphere"},
                       {}};
    const auto evaluators = study_evaluators();
    for (std::size_t k = 0; k < evaluators.size(); ++k) {
        double sphere = 0, hemisphere = 0, worst = 0, count = 0;
        for (const auto& one : cases) {
            if (!one.is_published()) continue;
            sphere += one.errors[k].sphere;
            hemisphere += one.errors[k].hemisphere;
            worst = std::max(worst, one.errors[k].sphere);
            ++count;
        }
        table.rows.push_back({evaluators[k].name, table_number(sphere / count, 3), table_number(hemisphere / count, 3),
                              table_number(worst, 3)});
    }
    return table;
}

Study::Table case_table(const std::vector<StudyCase>& cases, std::size_t k) {
    Study::Table table{
        "Relative error of " + study_evaluators()[k].name, "Axes over the sphere.", {"alpha", "n.v"}, {}};
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
        "White furnace: reflected part of a constant radiance of 1, without Fresnel",
        "In brackets the part that Schlick's power takes, so that F0 reflects F0 (A - B) + B. 4096 rays; "
        "the rest, up to 1, would leave the surface after more than one reflection.",
        {"alpha"},
        {}};
    const std::array cosines = {1.f, .95f, .6f, .25f, .1f};
    for (float cosine : cosines) table.columns.push_back("n.v " + table_number(static_cast<double>(cosine)));
    for (float alpha : {.05f, .1f, .25f, .5f, .8f, 1.f}) {
        std::vector<std::string> row = {table_number(static_cast<double>(alpha))};
        for (float cosine : cosines) {
            const auto lobe = ggx::lobe_by_rays(ggx::make_view(cosine, alpha), k_reference_rays);
            row.push_back(table_number(static_cast<double>(lobe.albedo), 3) + " (" +
                          table_number(static_cast<double>(lobe.fresnel), 2) + ")");
        }
        table.rows.push_back(row);
    }
    return table;
}

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
                const auto reference = make_sampled_specular(basis, 1024);
                const auto c = power_of_height(degree);
                const PointsAtAngle points(100, cosine, alpha);
                std::vector<std::string> row = {table_number(static_cast<double>(alpha)),
                                                table_number(static_cast<double>(cosine)), std::to_string(degree)};
                for (const auto& name : sh_specular_names())
                    row.push_back(table_number(relative_specular_error(*basis->specular(name), *reference, c, points)));
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
    const auto evaluators = study_evaluators();
    for (std::size_t k = 0; k < evaluators.size(); ++k) {
        Study::Series series{evaluators[k].name, {}, {}};
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
    std::vector<double> angles;
    for (int degrees = -120; degrees <= 150; degrees += 2) angles.push_back(degrees);
    Directions axes(angles.size());
    for (std::size_t i = 0; i < angles.size(); ++i) {
        const double angle = angles[i] * k_pi / 180;
        set_entry(axes, i, Vec3{static_cast<float>(-std::sin(angle)), 0, static_cast<float>(std::cos(angle))});
    }
    const auto add = [&](std::string name, const std::vector<float>& values) {
        plot.series.push_back({std::move(name), angles, {values.begin(), values.end()}});
    };
    for (const auto& info : sg_specular_list())
        add(std::string(info.name), sg_specular(info.kind, view, sharpness, axes));
    add("4096 rays", study_by_rays(ggx::rays(view, k_reference_rays), sharpness, axes));
    return plot;
}

/// A sphere seen from +z: the points of its picture, four to a pixel, and the pixels that they belong to.
struct SpecularSphere {
    static constexpr std::size_t size = 128, subsamples = 2, across = size * subsamples;
    std::vector<std::size_t> owners;
    Directions normals, views;

    SpecularSphere() {
        std::vector<Vec3> all;
        for (std::size_t i = 0; i < across * across; ++i) {
            const std::size_t x = i % across, y = i / across;
            const float u = 1.08f * ((static_cast<float>(x) + 0.5f) / (0.5f * across) - 1);
            const float v = 1.08f * (1 - (static_cast<float>(y) + 0.5f) / (0.5f * across));
            if (u * u + v * v > 1) continue;
            all.push_back({u, v, std::sqrt(1 - u * u - v * v)});
            owners.push_back((y / subsamples) * size + x / subsamples);
        }
        normals = views = Directions(all.size());
        for (std::size_t i = 0; i < all.size(); ++i) {
            set_entry(normals, i, all[i]);
            set_entry(views, i, Vec3{0, 0, 1});
        }
    }
    [[nodiscard]] Image picture(const Colours& values, float brightest) const {
        Image image(size, size);
        for (std::size_t i = 0; i < owners.size(); ++i)
            image.pixels[owners[i]] =
                image.pixels[owners[i]] + colour_at(values, i) * (1 / (brightest * subsamples * subsamples));
        return image;
    }
};

void add_specular_spheres(Study& study, float alpha, float sharpness) {
    static const SpecularSphere sphere;
    const auto caption = "alpha " + table_number(static_cast<double>(alpha)) + ", sharpness " +
                         table_number(static_cast<double>(sharpness));
    const gaussian::Lobe lobe{normalize(Vec3{-0.5f, 0.6f, 0.62f}), sharpness};
    const std::vector<float> alphas(sphere.owners.size(), alpha);
    Colours values(sphere.owners.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto view = ggx::make_view(direction_at(sphere.normals, i), {0, 0, 1}, alpha);
        const float value = study_by_rays(ggx::rays(view, 256), sharpness, view.to_local(lobe.axis));
        set_entry(values, i, Rgb{value, value, value});
    }
    const float brightest = *std::max_element(values.channel(0), values.channel(0) + values.size());
    study.pictures.push_back({"256 rays", caption, sphere.picture(values, brightest)});
    for (const auto& info : sg_specular_list()) {
        make_sg_specular(info.name, {lobe})
            ->reflected(std::vector<Rgb>{{1, 1, 1}}, {sphere.normals, sphere.views, alphas}, values);
        study.pictures.push_back({std::string(info.name), caption, sphere.picture(values, brightest)});
    }
}

}  // namespace

PointsAtAngle::PointsAtAngle(std::size_t count, float cosine, float alpha)
    : normals(count), views(count), alphas(count, alpha) {
    const Directions all = uniform_directions(Domain::sphere, Sequence::sobol, count, 4);
    const float sine = std::sqrt(1 - cosine * cosine);
    for (std::size_t i = 0; i < count; ++i) {
        const auto frame = ggx::make_view(direction_at(all, i), direction_at(all, (i + 1) % count), alpha);
        set_entry(normals, i, frame.z);
        set_entry(views, i, normalize(frame.to_world({sine, 0, cosine})));
    }
}

double relative_specular_error(const SpecularEvaluator& evaluator, const SpecularEvaluator& reference,
                               std::span<const Rgb> c, const PointsAtAngle& points) {
    Colours out(points.alphas.size()), exact(points.alphas.size());
    evaluator.reflected(c, points.view(), out);
    reference.reflected(c, points.view(), exact);
    double error = 0, whole = 0;
    for (std::size_t i = 0; i < out.size(); ++i) {
        const auto e = static_cast<double>(colour_at(exact, i).g), d = static_cast<double>(colour_at(out, i).g) - e;
        error += d * d;
        whole += e * e;
    }
    return std::sqrt(error / whole);
}

Study study_specular() {
    Study study;
    study.name = "specular";
    study.title = "Specular reflection of lobes and harmonics";
    study.summary =
        "A lobe exp(lambda (l.p - 1)) lights a GGX surface: the reflected radiance is the integral of the lobe times "
        "D G / (4 n.v) over the hemisphere, without Fresnel. Each evaluator is compared with rays along visible "
        "normals, "
        "over roughness, view angle and sharpness; spherical harmonics likewise.";
    const auto cases = all_specular_cases();
    study.tables.push_back(mean_specular_table(cases));
    for (std::size_t k = 0; k < sg_specular_list().size(); ++k) study.tables.push_back(case_table(cases, k));
    study.tables.push_back(harmonics_table());
    study.tables.push_back(furnace_table());
    study.plots.push_back(sharpness_plot(cases));
    for (const auto& [alpha, cosine, sharpness] :
         {std::array{.1f, .25f, 16.f}, {.25f, .6f, 16.f}, {.5f, .6f, 6.f}, {.8f, .6f, 64.f}})
        study.plots.push_back(curve_plot(alpha, cosine, sharpness));
    for (float alpha : {.1f, .25f, .5f}) add_specular_spheres(study, alpha, 16);
    return study;
}

}  // namespace lobelia
