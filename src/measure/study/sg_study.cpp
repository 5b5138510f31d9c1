// The study of irradiance from one spherical Gaussian.
#include "measure/study/sg_study.h"

#include "core/basis/sg/sg_irradiance.h"
#include "core/math/harmonics.h"

namespace lobelia {
namespace {

constexpr std::array k_sharpnesses = {.5, 1., 2., 4., 8., 16., 32., 64.};

/// Cosines from -1 to 1 in equal steps.
std::vector<float> cosine_grid(std::size_t count) {
    std::vector<float> cosines(count);
    for (std::size_t i = 0; i < count; ++i)
        cosines[i] = static_cast<float>(-1 + 2 * static_cast<double>(i) / static_cast<double>(count - 1));
    return cosines;
}

/// Largest and root mean square |error| / I over the sphere (equal steps in cosine are equal areas).
struct FormulaError {
    double largest = 0, rms = 0;
};

FormulaError formula_error(SgIrradiance kind, double sharpness) {
    const auto cosines = cosine_grid(2001);
    const auto values = sg_irradiance(kind, sharpness, cosines);
    const auto series = gaussian::irradiance_series(sharpness);
    const double integral = gaussian::integral(sharpness);
    FormulaError e;
    for (std::size_t i = 0; i < cosines.size(); ++i) {
        const double error = std::abs(values[i] - gaussian::zonal_sum(series, cosines[i])) / integral;
        e.largest = std::max(e.largest, error);
        e.rms += error * error;
    }
    e.rms = std::sqrt(e.rms / static_cast<double>(cosines.size()));
    return e;
}

Study::Table error_table() {
    Study::Table table{"Largest |error| / I (root mean square over the sphere / I), in float32",
                       "I is the lobe's integral. Error against the zonal series in double precision, 2001 cosines.",
                       {"evaluator"},
                       {}};
    for (double sharpness : k_sharpnesses) table.columns.push_back(table_number(sharpness));
    for (const auto& entry : sg_irradiance_list()) {
        std::vector<std::string> row = {std::string(entry.name)};
        for (double sharpness : k_sharpnesses) {
            const FormulaError e = formula_error(entry.kind, sharpness);
            row.push_back(table_number(e.largest) + " (" + table_number(e.rms) + ")");
        }
        table.rows.push_back(row);
    }
    return table;
}

Study::Plot error_plot() {
    Study::Plot plot{"Largest error against sharpness", "Each formula in float32.", "sharpness", "largest |error| / I",
                     Study::Axis::logarithmic,          Study::Axis::logarithmic,   {}};
    for (const auto& entry : sg_irradiance_list()) {
        Study::Series series{std::string(entry.name), {}, {}};
        for (double sharpness = .1; sharpness < 1001; sharpness *= std::sqrt(2.0)) {
            series.x.push_back(sharpness);
            series.y.push_back(formula_error(entry.kind, sharpness).largest);
        }
        plot.series.push_back(std::move(series));
    }
    return plot;
}

/// Degrees from 0 to 180.
std::vector<double> angle_grid() {
    std::vector<double> angles;
    for (int i = 0; i <= 180; ++i) angles.push_back(i);
    return angles;
}

Study::Plot cosine_plot() {
    Study::Plot plot{"The clamped cosine and its approximations",
                     "Basis of each irradiance formula: the cosine as one lobe, or as a few harmonics.",
                     "angle [degrees]",
                     "value",
                     Study::Axis::linear,
                     Study::Axis::linear,
                     {}};
    const auto angles = angle_grid();
    const auto add = [&](const std::string& name, const auto& f) {
        Study::Series series{name, angles, {}};
        for (double angle : angles) series.y.push_back(f(std::cos(angle * k_pi / 180)));
        plot.series.push_back(std::move(series));
    };
    // Degree l of the clamped cosine is (2l + 1) / (4 pi) A_l P_l(c).
    const auto harmonics_to = [](std::size_t degree) {
        return [degree](double c) {
            std::vector<double> series;
            for (std::size_t l = 0; l <= degree; ++l)
                series.push_back(static_cast<double>(2 * l + 1) / (4 * k_pi) * harmonics::clamped_cosine(l));
            return gaussian::zonal_sum(series, c);
        };
    };
    add("max(0, cos)", [](double c) { return std::max(0.0, c); });
    add("1.17 SG(2.133)", [](double c) { return 1.17 * std::exp(2.133 * (c - 1)); });
    add("32.7080 SG(0.0315) - 31.7003, upper hemisphere",
        [](double c) { return c >= 0 ? 32.7080 * std::exp(0.0315 * (c - 1)) - 31.7003 : 0; });
    add("SH degree 1", harmonics_to(1));
    add("SH degree 2", harmonics_to(2));
    return plot;
}

Study::Plot irradiance_plot(double sharpness) {
    Study::Plot plot{"Irradiance of a lobe of sharpness " + table_number(sharpness),
                     "E / I against the angle between normal and axis; the exact curve is the numeric integral.",
                     "angle [degrees]",
                     "E / I",
                     Study::Axis::linear,
                     Study::Axis::linear,
                     {}};
    const auto angles = angle_grid();
    std::vector<float> cosines;
    Study::Series numeric{"numeric integral", angles, {}};
    const double integral = gaussian::integral(sharpness);
    for (double angle : angles) {
        cosines.push_back(static_cast<float>(std::cos(angle * k_pi / 180)));
        numeric.y.push_back(gaussian::irradiance_by_quadrature(sharpness, cosines.back()) / integral);
    }
    plot.series.push_back(std::move(numeric));
    for (const auto& entry : sg_irradiance_list()) {
        Study::Series series{std::string(entry.name), angles, {}};
        for (float value : sg_irradiance(entry.kind, sharpness, cosines)) series.y.push_back(value / integral);
        plot.series.push_back(std::move(series));
    }
    return plot;
}

/// A white sphere seen from +z, lit by one lobe from the upper left, by `irradiance(cosine)`, brightest point 1.
template <class Irradiance>
Image lit_sphere(const Irradiance& irradiance) {
    constexpr std::size_t size = 160, subsamples = 3;
    const Vec3 axis = normalize(Vec3{-0.5f, 0.6f, 0.62f});
    std::vector<float> cosines;
    std::vector<std::size_t> owners;
    for (std::size_t i = 0; i < size * size * subsamples * subsamples; ++i) {
        const std::size_t across = size * subsamples, x = i % across, y = i / across;
        const float u = (static_cast<float>(x) + 0.5f) / (0.5f * static_cast<float>(across)) - 1;
        const float v = 1 - (static_cast<float>(y) + 0.5f) / (0.5f * static_cast<float>(across));
        const float squared = 1.08f * 1.08f * (u * u + v * v);
        if (squared > 1) continue;
        cosines.push_back(dot(axis, {1.08f * u, 1.08f * v, std::sqrt(1 - squared)}));
        owners.push_back((y / subsamples) * size + x / subsamples);
    }
    const std::vector<float> values = irradiance(cosines);
    Image image(size, size);
    constexpr float share = 1.0f / (subsamples * subsamples);
    for (std::size_t i = 0; i < values.size(); ++i)
        image.pixels[owners[i]] = image.pixels[owners[i]] + Rgb{1, 1, 1} * (std::max(0.0f, values[i]) * share);
    return image;
}

void add_spheres(Study& study, double sharpness) {
    const double brightest = gaussian::irradiance(sharpness, 1);
    const auto caption = "sharpness " + table_number(sharpness);
    study.pictures.push_back({"numeric integral", caption, lit_sphere([&](const std::vector<float>& cosines) {
                                  const auto series = gaussian::irradiance_series(sharpness);
                                  std::vector<float> values;
                                  for (float c : cosines)
                                      values.push_back(static_cast<float>(gaussian::zonal_sum(series, c) / brightest));
                                  return values;
                              })});
    for (const auto& entry : sg_irradiance_list())
        study.pictures.push_back(
            {std::string(entry.name),
             caption + ", largest error " + table_number(formula_error(entry.kind, sharpness).largest) + " I",
             lit_sphere([&](const std::vector<float>& cosines) {
                 auto values = sg_irradiance(entry.kind, sharpness, cosines);
                 for (float& v : values) v /= static_cast<float>(brightest);
                 return values;
             })});
}

}  // namespace

Study study_sg_irradiance() {
    Study study;
    study.name = "irradiance";
    study.title = "Irradiance from a spherical Gaussian";
    study.summary =
        "A lobe G(s) = exp(lambda (s.p - 1)) lights a surface of normal n: E = integral of G max(0, s.n). Each formula "
        "is compared, in float32, with the exact zonal series, over the angle between n and p and over sharpness.";
    study.tables.push_back(error_table());
    study.plots.push_back(cosine_plot());
    study.plots.push_back(error_plot());
    for (double sharpness : {1., 4., 16., 64.}) study.plots.push_back(irradiance_plot(sharpness));
    for (double sharpness : {1., 4., 16.}) add_spheres(study, sharpness);
    return study;
}

}  // namespace lobelia
