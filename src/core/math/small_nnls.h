// Non-negative least squares of a handful of unknowns, without allocation. Lawson and Hanson 1974; Bro and de Jong
// 1997.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace lobelia {

/// The b >= 0 with the least b^T G b - 2 m^T b of at most Most unknowns, by Lawson and Hanson's active set, starting
/// from the set that was free the last time: in a search that is mostly still the right one.
template <std::size_t Most>
class SmallNnls {
  public:
    using Vector = std::array<double, Most>;
    /// `gram` is n x n; `free` says which unknowns were, and then are, positive.
    static Vector solve(std::span<const double> gram, const Vector& m, std::size_t n, std::array<bool, Most>& free) {
        Vector b{};
        for (std::size_t step = 0; step < 4 * n + 4; ++step) {
            // Drop what turns negative until nothing does.
            for (std::size_t drops = 0; drops <= n; ++drops) {
                b = solve_free(gram, m, n, free);
                std::size_t worst = n;
                for (std::size_t i = 0; i < n; ++i)
                    if (free[i] && b[i] <= 0 && (worst == n || b[i] < b[worst])) worst = i;
                if (worst == n) break;
                free[worst] = false;
            }
            // Free what would grow most.
            std::size_t best = n;
            double most = 1e-10;
            for (std::size_t i = 0; i < n; ++i) {
                if (free[i]) continue;
                double slope = m[i];
                for (std::size_t j = 0; j < n; ++j) slope -= gram[i * n + j] * b[j];
                const double share = slope / std::max(std::abs(m[i]), 1e-300);
                if (share > most) {
                    most = share;
                    best = i;
                }
            }
            if (best == n) break;
            free[best] = true;
        }
        for (std::size_t i = 0; i < n; ++i) b[i] = free[i] ? std::max(b[i], 0.0) : 0;
        return b;
    }

  private:
    /// The solution among the free unknowns, by Cholesky's factors.
    static Vector solve_free(std::span<const double> gram, const Vector& m, std::size_t n,
                             const std::array<bool, Most>& free) {
        std::array<std::size_t, Most> place{};
        std::size_t count = 0;
        for (std::size_t i = 0; i < n; ++i)
            if (free[i]) place[count++] = i;
        std::array<std::array<double, Most>, Most> l{};
        Vector y{}, b{};
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t j = 0; j <= i; ++j) {
                double sum = gram[place[i] * n + place[j]];
                for (std::size_t k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
                l[i][j] = i == j ? std::sqrt(std::max(sum, 1e-12 * gram[place[i] * n + place[i]])) : sum / l[j][j];
            }
            double sum = m[place[i]];
            for (std::size_t k = 0; k < i; ++k) sum -= l[i][k] * y[k];
            y[i] = sum / l[i][i];
        }
        for (std::size_t i = count; i-- > 0;) {
            double sum = y[i];
            for (std::size_t k = i + 1; k < count; ++k) sum -= l[k][i] * b[place[k]];
            b[place[i]] = sum / l[i][i];
        }
        return b;
    }
};

}  // namespace lobelia
