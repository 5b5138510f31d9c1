// ZH3: the search for the axis, in closed form given the axis, and reading as zonal quadratics.
#include "core/basis/sh/zh3.h"

#include <Eigen/Dense>
#include <algorithm>

#include "core/basis/sh/sh_shader.h"
#include "core/basis/sh/spherical_harmonics.h"
#include "core/math/harmonics_degree_2.h"
#include "core/math/zonal_quadratic.h"

namespace lobelia {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t k_coefficients = 5, k_accumulated = 9;

const Vector3d k_luminance(0.2126, 0.7152, 0.0722);

/// Row k is the channel's: degree 1 as a vector (x, y, z).
Matrix3d vectors_of(std::span<const Rgb> c) {
    Matrix3d v;
    v << c[3].r, c[1].r, c[2].r, c[3].g, c[1].g, c[2].g, c[3].b, c[1].b, c[2].b;
    return v;
}

/// Degree 2 of a channel as the form w^T M w that it is.
Matrix3d form_of(std::span<const Rgb> c, std::size_t k) {
    const auto form = degree_2(c, k).form;
    Matrix3d m;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) m(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = form[i][j];
    return m;
}

/// The gain of an axis: F(a) = a^T B a + sum_k s (a^T M_k a)^2, the reduction of the irradiance error.
struct Gain {
    Matrix3d b;
    std::vector<Matrix3d> forms;
    double s = 0;

    [[nodiscard]] double operator()(const Vector3d& a) const {
        double sum = a.dot(b * a);
        for (const Matrix3d& m : forms) sum += s * std::pow(a.dot(m * a), 2);
        return sum;
    }
    void derivatives(const Vector3d& a, Vector3d& gradient, Matrix3d& hessian) const {
        gradient = 2 * b * a;
        hessian = 2 * b;
        for (const Matrix3d& m : forms) {
            const Vector3d ma = m * a;
            const double f = a.dot(ma);
            gradient += 4 * s * f * ma;
            hessian += 4 * s * (f * m + 2 * ma * ma.transpose());
        }
    }
};

/// Climbs to a maximum on the sphere: Newton's step in the tangent plane where it is one, else along the gradient,
/// shortened until the gain grows.
Vector3d climbed(const Gain& gain, Vector3d a) {
    double value = gain(a);
    for (int iteration = 0; iteration < 30; ++iteration) {
        Vector3d gradient;
        Matrix3d hessian;
        gain.derivatives(a, gradient, hessian);
        const Matrix3d tangent = Matrix3d::Identity() - a * a.transpose();
        const Vector3d slope = tangent * gradient;
        if (slope.norm() <= 1e-12 * std::max(std::abs(value), 1e-300)) break;
        // The curvature along great circles; its third direction, along a, is made -1 so that it can be inverted.
        const double scale = std::max(hessian.cwiseAbs().maxCoeff(), 1e-300);
        const Matrix3d curvature = tangent * (hessian - a.dot(gradient) * Matrix3d::Identity()) * tangent;
        const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(curvature - scale * a * a.transpose());
        const Vector3d values = solver.eigenvalues().cwiseAbs().cwiseMax(1e-9 * scale);
        Vector3d step = solver.eigenvectors() * (solver.eigenvectors().transpose() * slope).cwiseQuotient(values);
        step -= a * a.dot(step);
        if (step.norm() > 0.5) step *= 0.5 / step.norm();
        bool better = false;
        for (int halving = 0; halving < 20 && !better; ++halving, step *= 0.5) {
            const Vector3d next = (a + step).normalized();
            const double gained = gain(next);
            if (gained > value) {
                a = next;
                value = gained;
                better = true;
            }
        }
        if (!better) break;
    }
    return a;
}

/// The axis of the largest gain, climbed to from degree 1's own and from the main axes of the forms.
Vector3d best_axis(const Gain& gain, const Vector3d& own) {
    Vector3d best = Vector3d::UnitZ();
    double most = -1;
    const auto attempt = [&](const Vector3d& start) {
        const Vector3d a = climbed(gain, start);
        if (gain(a) <= most * (1 + 1e-9)) return;
        most = gain(a);
        best = a;
    };
    if (own.norm() > 0) attempt(own.normalized());
    Matrix3d sum = Matrix3d::Zero();
    for (const Matrix3d& m : gain.forms) sum += m;
    const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(sum);
    for (Eigen::Index i = 0; i < 3; ++i) attempt(solver.eigenvectors().col(i));
    return best;
}

/// A_1^2, and A_2^2 4 pi / 5: the zonal part of a band 2 that is f on the axis is z = sqrt(4 pi / 5) f.
const double k_vector_weight = std::pow(2 * k_pi / 3, 2);
const double k_form_weight = std::pow(k_pi / 4, 2) * 4 * k_pi / 5;

/// Degree 1 along `axis` where it is all but 0 there, so that the axis can be read from it.
double readable(double along, double mean) {
    const double least = 1e-4 * std::max(mean, 0.0);
    return std::abs(along) >= least ? along : along < 0 ? -least : least;
}

/// Vectors (rows: channels) whose luminance is along `a`, the nearest to the given ones; `weights` are the channels'
/// parts in the luminance, 0 for those that have no light to move.
Matrix3d with_axis(const Matrix3d& vectors, const Vector3d& a, double mean, const Vector3d& weights) {
    const Vector3d luminance = vectors.transpose() * k_luminance;
    const Vector3d change = a * readable(luminance.dot(a), mean) - luminance;
    return vectors + weights * change.transpose() / std::max(weights.squaredNorm(), 1e-300);
}

std::array<Vector3d, 3> axes_of(std::span<const Rgb> c, Zh3::Axis axis) {
    const Matrix3d vectors = vectors_of(c);
    std::array<Vector3d, 3> axes;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vector3d own = axis == Zh3::Axis::shared ? Vector3d(vectors.transpose() * k_luminance)
                                                       : Vector3d(vectors.row(static_cast<Eigen::Index>(k)));
        axes[k] = own.norm() > 1e-30 ? Vector3d(own.normalized()) : Vector3d(Vector3d::UnitZ());
    }
    return axes;
}

/// Radiance, or with the factors of the clamped cosine irradiance, of each channel.
std::array<ZonalQuadratic, 3> functions_of(std::span<const Rgb> c, Zh3::Axis axis, const std::array<double, 3>& bands) {
    const Matrix3d vectors = vectors_of(c);
    const auto axes = axes_of(c, axis);
    std::array<ZonalQuadratic, 3> result;
    const double mean[] = {c[0].r, c[0].g, c[0].b}, z[] = {c[4].r, c[4].g, c[4].b};
    const auto vec = [](const Vector3d& v) {
        return Vec3{static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
    };
    for (std::size_t k = 0; k < 3; ++k) {
        result[k].constant = static_cast<float>(bands[0] * std::sqrt(1 / (4 * k_pi)) * mean[k]);
        result[k].linear = vec(bands[1] * std::sqrt(3 / (4 * k_pi)) * vectors.row(static_cast<Eigen::Index>(k)));
        result[k].quadratic = static_cast<float>(bands[2] * std::sqrt(5 / (4 * k_pi)) * z[k]);
        result[k].axis = vec(axes[k]);
    }
    return result;
}

sh_shader::ZonalAxisCode code_of(Zh3::Axis axis) {
    return axis == Zh3::Axis::shared ? sh_shader::ZonalAxisCode::of_luminance : sh_shader::ZonalAxisCode::of_channel;
}

class Zh3Convolution final : public Evaluator {
  public:
    Zh3Convolution(Zh3::Axis axis, Negative negative) : axis_(axis), negative_(negative) {}
    [[nodiscard]] std::string name() const override {
        return negative_ == Negative::clamped ? "convolution" : "convolution-signed";
    }
    [[nodiscard]] Negative negative() const override { return negative_; }
    [[nodiscard]] Accuracy accuracy() const override {
        return {"everywhere", "1e-6 of the largest E (float32 rounding)"};
    }
    void signed_irradiance(std::span<const Rgb> c, DirectionView normals, MutableColourView out) const override {
        check_evaluation(k_coefficients, c, normals, out);
        evaluate(functions_of(c, axis_, {k_pi, 2 * k_pi / 3, k_pi / 4}), normals, out);
    }
    [[nodiscard]] Result<ShaderCode> irradiance_code() const override {
        return sh_shader::zonal(std::array{k_pi, 2 * k_pi / 3, k_pi / 4}, code_of(axis_), "n");
    }

  private:
    Zh3::Axis axis_;
    Negative negative_;
};

}  // namespace

std::shared_ptr<const FittedBasis> zh3(ZonalAxis axis) { return std::make_shared<Zh3>(axis); }

Result<std::shared_ptr<const Basis>> Zh3::from_name(std::string_view name) {
    for (const Axis axis : {Axis::shared, Axis::per_channel}) {
        auto basis = std::make_shared<Zh3>(axis);
        if (basis->name() == name) return std::shared_ptr<const Basis>(std::move(basis));
    }
    return std::shared_ptr<const Basis>();
}

std::shared_ptr<const LinearBasis> Zh3::accumulated() const { return std::make_shared<SphericalHarmonics>(2); }

void Zh3::fit(std::span<const Rgb> accumulated, std::span<Rgb> c) const {
    check_equal("accumulated coefficients", accumulated.size(), k_accumulated);
    check_equal("coefficients", c.size(), k_coefficients);
    const Matrix3d vectors = vectors_of(accumulated);
    const double means[] = {accumulated[0].r, accumulated[0].g, accumulated[0].b};
    Matrix3d found;
    Vector3d z;
    // The part of band 2 along Y_20(a . w), by the addition theorem.
    const auto zonal_part = [&](std::size_t k, const Vector3d& a) {
        return std::sqrt(4 * k_pi / 5) * a.dot(form_of(accumulated, k) * a);
    };
    if (axis_ == Axis::shared) {
        const Vector3d luminance = vectors.transpose() * k_luminance;
        Vector3d weights = k_luminance;
        for (Eigen::Index k = 0; k < 3; ++k)
            if (!(means[k] > 0)) weights(k) = 0;
        Gain gain{k_vector_weight / std::max(weights.squaredNorm(), 1e-300) * luminance * luminance.transpose(),
                  {},
                  k_form_weight};
        for (std::size_t k = 0; k < 3; ++k) gain.forms.push_back(form_of(accumulated, k));
        const Vector3d a = best_axis(gain, luminance);
        found = with_axis(vectors, a, k_luminance.dot(Vector3d(means[0], means[1], means[2])), weights);
        for (std::size_t k = 0; k < 3; ++k) z(static_cast<Eigen::Index>(k)) = zonal_part(k, a);
    } else {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto row = static_cast<Eigen::Index>(k);
            const Vector3d own = vectors.row(row);
            const Gain gain{k_vector_weight * own * own.transpose(), {form_of(accumulated, k)}, k_form_weight};
            const Vector3d a = best_axis(gain, own);
            found.row(row) = a * readable(own.dot(a), means[k]);
            z(row) = zonal_part(k, a);
        }
    }
    c[0] = accumulated[0];
    const auto column = [&](Eigen::Index i) {
        return Rgb{static_cast<float>(found(0, i)), static_cast<float>(found(1, i)), static_cast<float>(found(2, i))};
    };
    c[1] = column(1);
    c[2] = column(2);
    c[3] = column(0);
    c[4] = {static_cast<float>(z(0)), static_cast<float>(z(1)), static_cast<float>(z(2))};
}

void Zh3::radiance(std::span<const Rgb> c, DirectionView directions, MutableColourView out) const {
    check_evaluation(k_coefficients, c, directions, out);
    evaluate(functions_of(c, axis_, {1, 1, 1}), directions, out);
}

Result<ShaderCode> Zh3::radiance_code() const {
    return sh_shader::zonal(std::array{1.0, 1.0, 1.0}, code_of(axis_), "w");
}

std::string Zh3::description() const {
    return axis_ == Axis::shared ? "degree-1 harmonics and zonal degree 2 about the axis of the luminance"
                                 : "degree-1 harmonics and zonal degree 2 about each channel's own axis";
}

std::shared_ptr<const Evaluator> Zh3::evaluator(std::string_view name) const {
    if (name == "convolution") return std::make_shared<Zh3Convolution>(axis_, Negative::clamped);
    if (name == "convolution-signed") return std::make_shared<Zh3Convolution>(axis_, Negative::kept);
    return nullptr;
}

std::vector<float> Zh3::lead_bounds() const {
    if (axis_ == Axis::shared) return {};
    const float degree_1 = std::sqrt(3.0f), degree_2 = std::sqrt(5.0f);
    return {1, degree_1, degree_1, degree_1, degree_2};
}

Basis::Rotated Zh3::rotated(const Rotation& r, std::span<const Rgb> c) const {
    check_equal("coefficients", c.size(), k_coefficients);
    std::vector<Rgb> turned = harmonics::rotated(r, c.first(4));
    turned.push_back(c[4]);
    return {std::make_shared<Zh3>(axis_), std::move(turned)};
}

}  // namespace lobelia
