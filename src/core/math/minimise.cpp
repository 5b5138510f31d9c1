// L-BFGS with a backtracking line search.
#include "core/math/minimise.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lobelia {
namespace {

double dot(std::span<const double> a, std::span<const double> b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

double largest(std::span<const double> a) {
    double result = 0;
    for (double v : a) result = std::max(result, std::abs(v));
    return result;
}

/// The last steps and gradients: rings of vectors, allocated once.
class History {
  public:
    History(std::size_t depth, std::size_t size)
        : depth_(depth), size_(size), steps_(depth * size), changes_(depth * size), rho_(depth), alpha_(depth) {}

    /// Keeps a pair if it curves upwards.
    void keep(std::span<const double> step, std::span<const double> change) {
        const double curvature = dot(step, change);
        if (!(curvature > 1e-12 * std::sqrt(dot(step, step) * dot(change, change)))) return;
        const std::size_t place = next_++ % depth_;
        std::copy(step.begin(), step.end(), at(steps_, place).begin());
        std::copy(change.begin(), change.end(), at(changes_, place).begin());
        rho_[place] = 1 / curvature;
        scale_ = curvature / dot(change, change);
    }
    void forget() { next_ = 0; }
    [[nodiscard]] bool empty() const { return next_ == 0; }

    /// d becomes the approximate inverse Hessian times d (two-loop recursion).
    void apply(std::span<double> d) {
        const std::size_t count = std::min(next_, depth_);
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t place = (next_ - 1 - i) % depth_;
            alpha_[place] = rho_[place] * dot(at(steps_, place), d);
            add(d, at(changes_, place), -alpha_[place]);
        }
        for (double& v : d) v *= scale_;
        for (std::size_t i = count; i-- > 0;) {
            const std::size_t place = (next_ - 1 - i) % depth_;
            add(d, at(steps_, place), alpha_[place] - rho_[place] * dot(at(changes_, place), d));
        }
    }

  private:
    [[nodiscard]] std::span<double> at(std::vector<double>& list, std::size_t place) const {
        return std::span(list).subspan(place * size_, size_);
    }
    static void add(std::span<double> d, std::span<const double> v, double factor) {
        for (std::size_t i = 0; i < d.size(); ++i) d[i] += factor * v[i];
    }

    std::size_t depth_, size_, next_ = 0;
    std::vector<double> steps_, changes_, rho_, alpha_;
    double scale_ = 1;
};

/// Computes a descent direction from the curvature of the last steps, or along the gradient if that leads uphill.
/// Returns the slope along it.
double find_direction(History& history, std::span<const double> gradient, std::span<double> direction) {
    const auto along_gradient = [&] {
        for (std::size_t i = 0; i < direction.size(); ++i) direction[i] = -gradient[i];
    };
    along_gradient();
    history.apply(direction);
    const double slope = dot(direction, gradient);
    if (slope < 0) return slope;
    history.forget();
    along_gradient();
    return dot(direction, gradient);
}

/// A place, f there and its gradient.
struct Place {
    std::vector<double> x, gradient;
    double value = 0;
};

/// Shortens the step until it gains its share; false if none does.
bool step_down(const Objective& f, const Place& from, std::span<const double> direction, double slope, double length,
               Place& to) {
    for (int halving = 0; halving < 12; ++halving, length *= 0.4) {
        for (std::size_t i = 0; i < to.x.size(); ++i) to.x[i] = from.x[i] + length * direction[i];
        to.value = f(to.x, to.gradient);
        if (to.value <= from.value + 1e-4 * length * slope) return true;
    }
    return false;
}

}  // namespace

double minimise(const Objective& f, std::span<double> x, const MinimiseOptions& options) {
    const std::size_t n = x.size();
    History history(options.history, n);
    Place here{{x.begin(), x.end()}, std::vector<double>(n), 0}, next = here;
    std::vector<double> direction(n), step(n), change(n);
    here.value = f(here.x, here.gradient);
    for (std::size_t iteration = 0; iteration < options.most_steps; ++iteration) {
        // Aim, and go no further than is trusted.
        const double slope = find_direction(history, here.gradient, direction);
        const double reach = largest(direction);
        if (!(slope < 0) || !(reach > 0)) break;
        const double most = (history.empty() ? options.first_step : options.longest_step) / reach;
        const double length = history.empty() ? most : std::min(1.0, most);
        if (!step_down(f, here, direction, slope, length, next)) {
            if (history.empty()) break;
            history.forget();
            continue;
        }

        // Remember how the gradient changed on the way.
        for (std::size_t i = 0; i < n; ++i) {
            step[i] = next.x[i] - here.x[i];
            change[i] = next.gradient[i] - here.gradient[i];
        }
        history.keep(step, change);
        const double gained = here.value - next.value;
        std::swap(here, next);
        if (gained <= options.least_change * std::abs(here.value)) break;
    }
    std::copy(here.x.begin(), here.x.end(), x.begin());
    return here.value;
}

}  // namespace lobelia
