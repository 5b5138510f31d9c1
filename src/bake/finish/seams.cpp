// Seams closed by least squares over the texels that bilinear filtering reads along them (Iwanicki 2013).
#include <oneapi/tbb/parallel_for.h>

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>

#include "bake/finish/find_seams.h"
#include "bake/finish/finish.h"
#include "bake/finish/nearest.h"

namespace lobelia {
namespace {

/// Points along a seam [per texel], and of all seams together at most.
constexpr double k_points_per_texel = 2;
constexpr double k_most_points = 1 << 21;
/// So much of a footprint must be there for its point to count.
constexpr float k_least_footprint = 0.25f;

/// A texel of all pages, and how much of it counts.
struct Share {
    std::uint64_t texel = 0;
    float weight = 0;
};

/// Reads what bilinear filtering will read once texels are dilated, as sums over texels that hold something.
class Footprints {
  public:
    Footprints(std::span<const LightmapPage> pages, float least_validity) : pages_(pages) {
        for (const LightmapPage& page : pages) {
            nearest_.emplace_back(page, 2, least_validity);
            first_.push_back(first_.back() + page.size());
        }
    }

    /// Appends the shares of the point `p` as chart `chart` (of a triangle) is read there; their weights sum to
    /// `total`. False, and nothing, where too little of it is there.
    bool append(std::size_t page, std::uint32_t chart, Vec2 p, float total, std::vector<Share>& out);
    /// The page of a texel, and which it is there.
    [[nodiscard]] std::pair<std::size_t, std::size_t> place(std::uint64_t texel) const {
        const auto page = std::upper_bound(first_.begin(), first_.end(), texel) - first_.begin() - 1;
        return {static_cast<std::size_t>(page), texel - first_[static_cast<std::size_t>(page)]};
    }

  private:
    std::span<const LightmapPage> pages_;
    std::vector<NearestTexels> nearest_;
    std::vector<std::uint64_t> first_{0};  ///< number of each page's first texel
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

/// Differences along all seams as rows over the texels near them, and below these one row for the change of each.
struct SeamSystem {
    std::vector<std::uint64_t> texels;  ///< the unknowns
    std::vector<double> weight;         ///< of each difference: the square of its row's scale
    SparseMatrix matrix;
};

/// One difference for each point of a seam: the shares [first[i], first[i + 1]) of both sides.
struct SeamDifferences {
    std::vector<Share> shares;
    std::vector<std::size_t> first{0};
    std::vector<double> weight;  ///< the texels of the seam that each stands for
};

SeamDifferences find_differences(const Atlas& atlas, std::span<const Seam> seams, Footprints& footprints) {
    double length = 0;
    for (const Seam& seam : seams) length += seam.texels();
    const double per_texel = std::min(k_points_per_texel, k_most_points / std::max(length, 1.0));
    SeamDifferences result;
    const auto& charts = atlas.chart_of_triangle();
    for (const Seam& seam : seams) {
        const auto points = static_cast<std::size_t>(std::ceil(std::max(1.0, seam.texels() * per_texel)));
        const double weight = seam.texels() / static_cast<double>(points);
        for (std::size_t i = 0; i < points; ++i) {
            const float s = (static_cast<float>(i) + 0.5f) / static_cast<float>(points);
            const auto append = [&](const SeamSide& side, double scale) {
                return footprints.append(atlas.page_of(side.triangle), charts[side.triangle],
                                         side.ends[0] * (1 - s) + side.ends[1] * s, static_cast<float>(scale),
                                         result.shares);
            };
            if (!append(seam.a, std::sqrt(weight)) || !append(seam.b, -std::sqrt(weight))) {
                result.shares.resize(result.first.back());
                continue;
            }
            result.first.push_back(result.shares.size());
            result.weight.push_back(weight);
        }
    }
    return result;
}

SeamSystem make_system(SeamDifferences differences, float change_weight) {
    // Number the texels in their order.
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

/// Sums of squared differences before and after, each point by its weight.
struct Squared {
    double before = 0, after = 0;
};

Squared close(std::span<LightmapPage> pages, const Footprints& footprints, const SeamSystem& system,
              std::size_t channel) {
    Eigen::VectorXd values(system.matrix.cols());
    for (std::size_t i = 0; i < system.texels.size(); ++i) {
        const auto [page, texel] = footprints.place(system.texels[i]);
        values[static_cast<Eigen::Index>(i)] = pages[page].planes[channel][texel];
    }
    const auto points = static_cast<Eigen::Index>(system.weight.size());
    Eigen::VectorXd wanted = system.matrix * -values;
    const double before = wanted.head(points).squaredNorm();
    wanted.tail(wanted.size() - points).setZero();

    Eigen::LeastSquaresConjugateGradient<SparseMatrix> solver;
    solver.setTolerance(1e-6);
    solver.setMaxIterations(300);
    solver.compute(system.matrix);
    const Eigen::VectorXd change = solver.solve(wanted);
    const double after = (system.matrix * change - wanted).head(points).squaredNorm();
    for (std::size_t i = 0; i < system.texels.size(); ++i) {
        const auto [page, texel] = footprints.place(system.texels[i]);
        pages[page].planes[channel][texel] += static_cast<float>(change[static_cast<Eigen::Index>(i)]);
    }
    return {before, after};
}

}  // namespace

SeamReport close_seams(std::span<LightmapPage> pages, const PageChannels& channels, const Atlas& atlas,
                       const SeamOptions& options) {
    const std::vector<Seam> seams = find_seams(atlas, options.tolerance);
    SeamReport report{.edges = seams.size()};
    Footprints footprints(pages, options.least_validity);
    const SeamSystem system = make_system(find_differences(atlas, seams, footprints), std::max(options.weight, 1e-6f));
    if (system.weight.empty()) return report;

    // All but the error, which is no light.
    std::vector<Squared> squared(channels.count());
    tbb::parallel_for(std::size_t{0}, channels.count(), [&](std::size_t channel) {
        if (channel != channels.error()) squared[channel] = close(pages, footprints, system, channel);
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
