// Closes seams by least squares over the texels that bilinear filtering uses along them (Iwanicki 2013).
#include <oneapi/tbb/parallel_for.h>

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>

#include "bake/finish/find_seams.h"
#include "bake/finish/finish.h"
#include "bake/finish/nearest.h"
#include "bake/finish/seam_walls.h"

namespace lobelia {
namespace {

/// Points along a seam [per texel], and the maximum over all seams.
constexpr double k_points_per_texel = 2;
constexpr double k_most_points = 1 << 21;
/// Points with a smaller covered fraction of their footprint are ignored.
constexpr float k_least_footprint = 0.25f;

/// A texel, numbered across all pages, and its weight.
struct Share {
    std::uint64_t texel = 0;
    float weight = 0;
};

/// Values of bilinear filtering after dilation, as sums over texels that hold light.
class Footprints {
  public:
    Footprints(std::span<const LightmapPage> pages, float least_validity, const SeamSurroundings& around)
        : pages_(pages) {
        for (std::size_t p = 0; p < pages.size(); ++p) {
            const std::span<const std::uint8_t> displaced =
                around.displaced.empty() ? std::span<const std::uint8_t>() : around.displaced[p];
            nearest_.emplace_back(pages[p], 2, least_validity, displaced);
            first_.push_back(first_.back() + pages[p].size());
        }
    }

    /// Appends the shares of the value of chart `chart` at point `p`; their weights sum to `total`. Returns false, and
    /// appends nothing, where too little of the footprint holds light.
    bool append(std::size_t page, std::uint32_t chart, Vec2 p, float total, std::vector<Share>& out);
    /// Returns the page of a texel, and its index there.
    [[nodiscard]] std::pair<std::size_t, std::size_t> place(std::uint64_t texel) const {
        const auto page = std::upper_bound(first_.begin(), first_.end(), texel) - first_.begin() - 1;
        return {static_cast<std::size_t>(page), texel - first_[static_cast<std::size_t>(page)]};
    }

  private:
    std::span<const LightmapPage> pages_;
    std::vector<NearestTexels> nearest_;
    std::vector<std::uint64_t> first_{0};  ///< index of each page's first texel
    std::vector<std::uint32_t> sources_;
};

bool Footprints::append(std::size_t page_index, std::uint32_t chart, Vec2 p, float total, std::vector<Share>& out) {
    const LightmapPage& page = pages_[page_index];
    const std::size_t begin = out.size();
    const float x = p.x - 0.5f, y = p.y - 0.5f, x0 = std::floor(x), y0 = std::floor(y);
    float found = 0;
    for (int corner = 0; corner < 4; ++corner) {
        const int dx = corner & 1, dy = corner >> 1;
        const float px = x0 + static_cast<float>(dx), py = y0 + static_cast<float>(dy);
        const float weight = (dx != 0 ? x - x0 : 1 - (x - x0)) * (dy != 0 ? y - y0 : 1 - (y - y0));
        if (px < 0 || py < 0 || px >= static_cast<float>(page.width) || py >= static_cast<float>(page.height)) continue;
        nearest_[page_index].find(static_cast<std::size_t>(py) * page.width + static_cast<std::size_t>(px), sources_);
        for (const std::uint32_t i : sources_) {
            if (page.chart[i] != chart + 1) continue;
            const float share = weight / static_cast<float>(sources_.size());
            out.push_back({first_[page_index] + i, share});
            found += share;
        }
    }
    if (found < k_least_footprint) {
        out.resize(begin);
        return false;
    }
    for (std::size_t i = begin; i < out.size(); ++i) out[i].weight *= total / found;
    return true;
}

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Linear system: one row for each difference along a seam; below, one row for the change of each texel.
struct SeamSystem {
    std::vector<std::uint64_t> texels;  ///< the unknowns
    std::vector<double> weight;         ///< of each difference: the square of its row's scale
    SparseMatrix matrix;
};

/// One difference for each point of a seam: the shares [first[i], first[i + 1]) of both sides.
struct SeamDifferences {
    std::vector<Share> shares;
    std::vector<std::size_t> first{0};
    std::vector<double> weight;  ///< length [texels] that each point represents
};

/// A point of a seam, at the fraction `s` of its length, and the length that it represents [texels].
struct SeamPoint {
    const Seam* seam = nullptr;
    float s = 0;
    double weight = 0;
};

/// Returns points along all seams, without those under a surface.
std::vector<SeamPoint> points_along(const Atlas& atlas, std::span<const Seam> seams, const PathTracer* tracer,
                                    StopFlag stop) {
    double length = 0;
    for (const Seam& seam : seams) length += seam.texels();
    const double per_texel = std::min(k_points_per_texel, k_most_points / std::max(length, 1.0));
    std::vector<SeamPoint> points;
    for (const Seam& seam : seams) {
        const auto count = static_cast<std::size_t>(std::ceil(std::max(1.0, seam.texels() * per_texel)));
        for (std::size_t i = 0; i < count; ++i)
            points.push_back({&seam, (static_cast<float>(i) + 0.5f) / static_cast<float>(count),
                              seam.texels() / static_cast<double>(count)});
    }
    if (tracer == nullptr) return points;
    tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
        stop.check();
        if (is_walled(*tracer, atlas, *points[i].seam, points[i].s)) points[i].seam = nullptr;
    });
    std::erase_if(points, [](const SeamPoint& p) { return p.seam == nullptr; });
    return points;
}

SeamDifferences find_differences(const Atlas& atlas, std::span<const SeamPoint> points, StopFlag stop,
                                 Footprints& footprints) {
    SeamDifferences result;
    const auto& charts = atlas.chart_of_triangle();
    for (const auto& [seam, s, weight] : points) {
        stop.check();
        const auto append = [&, s = s](const SeamSide& side, double scale) {
            return footprints.append(atlas.page_of(side.triangle), charts[side.triangle],
                                     side.ends[0] * (1 - s) + side.ends[1] * s, static_cast<float>(scale),
                                     result.shares);
        };
        if (!append(seam->a, std::sqrt(weight)) || !append(seam->b, -std::sqrt(weight))) {
            result.shares.resize(result.first.back());
            continue;
        }
        result.first.push_back(result.shares.size());
        result.weight.push_back(weight);
    }
    return result;
}

SeamSystem make_system(SeamDifferences differences, float change_weight) {
    // Number the texels in ascending order.
    SeamSystem system;
    const std::vector<Share>& shares = differences.shares;
    for (const Share& share : shares) system.texels.push_back(share.texel);
    std::sort(system.texels.begin(), system.texels.end());
    system.texels.erase(std::unique(system.texels.begin(), system.texels.end()), system.texels.end());
    const auto number = [&](std::uint64_t texel) {
        return static_cast<int>(std::lower_bound(system.texels.begin(), system.texels.end(), texel) -
                                system.texels.begin());
    };

    // Fill the matrix.
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(shares.size() + system.texels.size());
    for (std::size_t row = 0; row + 1 < differences.first.size(); ++row)
        for (std::size_t i = differences.first[row]; i < differences.first[row + 1]; ++i)
            entries.emplace_back(static_cast<int>(row), number(shares[i].texel), shares[i].weight);
    for (std::size_t i = 0; i < system.texels.size(); ++i)
        entries.emplace_back(static_cast<int>(differences.weight.size() + i), static_cast<int>(i),
                             std::sqrt(static_cast<double>(change_weight)));
    system.matrix.resize(static_cast<Eigen::Index>(differences.weight.size() + system.texels.size()),
                         static_cast<Eigen::Index>(system.texels.size()));
    system.matrix.setFromTriplets(entries.begin(), entries.end());
    system.weight = std::move(differences.weight);
    return system;
}

/// Minimum and maximum value of each unknown: those of the texels that its differences use. Least squares overshoot;
/// within these bounds non-negative light stays non-negative.
struct SeamBounds {
    std::vector<double> least, most;
};

SeamBounds bounds_of(const SeamSystem& system, const Eigen::VectorXd& values) {
    SeamBounds bounds{{values.begin(), values.end()}, {values.begin(), values.end()}};
    for (Eigen::Index row = 0; row < static_cast<Eigen::Index>(system.weight.size()); ++row) {
        double least = std::numeric_limits<double>::infinity(), most = -least;
        for (SparseMatrix::InnerIterator entry(system.matrix, row); entry; ++entry) {
            least = std::min(least, values[entry.col()]);
            most = std::max(most, values[entry.col()]);
        }
        for (SparseMatrix::InnerIterator entry(system.matrix, row); entry; ++entry) {
            const auto i = static_cast<std::size_t>(entry.col());
            bounds.least[i] = std::min(bounds.least[i], least);
            bounds.most[i] = std::max(bounds.most[i], most);
        }
    }
    return bounds;
}

/// Eigen's preconditioner for least squares; checks the stop flag at each iteration.
class StoppablePreconditioner : public Eigen::LeastSquareDiagonalPreconditioner<double> {
  public:
    using Base = Eigen::LeastSquareDiagonalPreconditioner<double>;
    void set_stop(StopFlag stop) { stop_ = stop; }
    template <class Right>
    auto solve(const Eigen::MatrixBase<Right>& right) const {
        stop_.check();
        return Base::solve(right);
    }

  private:
    StopFlag stop_;
};

/// Weighted sums of squared differences before and after.
struct Squared {
    double before = 0, after = 0;
};

Squared close(std::span<LightmapPage> pages, const Footprints& footprints, const SeamSystem& system,
              std::size_t channel, StopFlag stop) {
    Eigen::VectorXd values(system.matrix.cols());
    for (std::size_t i = 0; i < system.texels.size(); ++i) {
        const auto [page, texel] = footprints.place(system.texels[i]);
        values[static_cast<Eigen::Index>(i)] = pages[page].planes[channel][texel];
    }
    const auto points = static_cast<Eigen::Index>(system.weight.size());
    Eigen::VectorXd wanted = system.matrix * -values;
    const double before = wanted.head(points).squaredNorm();
    wanted.tail(wanted.size() - points).setZero();

    Eigen::LeastSquaresConjugateGradient<SparseMatrix, StoppablePreconditioner> solver;
    solver.preconditioner().set_stop(stop);
    solver.setTolerance(1e-6);
    solver.setMaxIterations(300);
    solver.compute(system.matrix);
    Eigen::VectorXd change = solver.solve(wanted);

    // Clamp to the bounds, which are floats: values within them are unchanged.
    const SeamBounds bounds = bounds_of(system, values);
    for (std::size_t i = 0; i < system.texels.size(); ++i) {
        const auto [page, texel] = footprints.place(system.texels[i]);
        const auto k = static_cast<Eigen::Index>(i);
        float& value = pages[page].planes[channel][texel];
        value = std::clamp(value + static_cast<float>(change[k]), static_cast<float>(bounds.least[i]),
                           static_cast<float>(bounds.most[i]));
        change[k] = value - values[k];
    }
    return {before, (system.matrix * change - wanted).head(points).squaredNorm()};
}

}  // namespace

SeamReport close_seams(std::span<LightmapPage> pages, const PageChannels& channels, const Atlas& atlas,
                       const SeamOptions& options, const SeamSurroundings& around) {
    const std::vector<Seam> seams = find_seams(atlas, options.tolerance, options.stop);
    SeamReport report{.edges = seams.size()};
    Footprints footprints(pages, options.least_validity, around);
    const SeamSystem system = make_system(
        find_differences(atlas, points_along(atlas, seams, around.tracer, options.stop), options.stop, footprints),
        std::max(options.weight, 1e-6f));
    if (system.weight.empty()) return report;

    // Close all channels except the error, which is not light.
    std::vector<Squared> squared(channels.count());
    tbb::parallel_for(std::size_t{0}, channels.count(), [&](std::size_t channel) {
        if (channel != channels.error()) squared[channel] = close(pages, footprints, system, channel, options.stop);
    });

    Squared irradiance;
    for (std::size_t k = 0; k < 3; ++k) {
        irradiance.before += squared[channels.irradiance(k)].before;
        irradiance.after += squared[channels.irradiance(k)].after;
    }
    double weight = 0;
    for (const double w : system.weight) weight += 3 * w;
    report.before = std::sqrt(irradiance.before / weight);
    report.after = std::sqrt(irradiance.after / weight);
    return report;
}

}  // namespace lobelia
