// Finishing steps, selected by the encoding.
#include "bake/finish/steps.h"

#include <oneapi/tbb/parallel_for.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace lobelia {
namespace {

using SquareMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

bool is_identity(const SquareMatrix& m) {
    constexpr double k_rounding = 1e-9;
    return (m - SquareMatrix::Identity(m.rows(), m.cols())).cwiseAbs().maxCoeff() < k_rounding;
}

/// Multiplies the coefficients of every texel by a matrix.
void transform(std::span<LightmapPage> pages, const PageChannels& channels, const SquareMatrix& matrix, StopFlag stop) {
    for (LightmapPage& page : pages)
        tbb::parallel_for(std::size_t{0}, page.height, [&](std::size_t y) {
            stop.check();
            Eigen::VectorXd c(matrix.cols());
            for (std::size_t i = y * page.width; i < (y + 1) * page.width; ++i)
                for (std::size_t k = 0; k < 3; ++k) {
                    for (std::size_t j = 0; j < channels.coefficients; ++j)
                        c[static_cast<Eigen::Index>(j)] = page.planes[channels.coefficient(j, k)][i];
                    const Eigen::VectorXd result = matrix * c;
                    for (std::size_t j = 0; j < channels.coefficients; ++j)
                        page.planes[channels.coefficient(j, k)][i] =
                            static_cast<float>(result[static_cast<Eigen::Index>(j)]);
                }
        });
}

/// Denoises pages that hold coefficients of a basis that others are fitted to. Such a fit uses moments, so the moments
/// are filtered: the coefficients may be large and cancel, and filtered separately they would not cancel.
void denoise_moments(std::span<LightmapPage> pages, const PageChannels& channels, const Guides& guides,
                     const LinearBasis& basis, const DenoiseOptions& options) {
    const std::vector<double> gram = basis.gram(), integrals = basis.integrals();
    const auto n = static_cast<Eigen::Index>(basis.size());
    const SquareMatrix moments_from_c = Eigen::Map<const SquareMatrix>(gram.data(), n, n);
    if (is_identity(moments_from_c))
        return denoise(pages, channels, guides, integrals, solid_angle(basis.domain()), options);
    const SquareMatrix c_from_moments = moments_from_c.ldlt().solve(SquareMatrix::Identity(n, n));
    const Eigen::VectorXd of_moments = c_from_moments * Eigen::Map<const Eigen::VectorXd>(integrals.data(), n);
    transform(pages, channels, moments_from_c, options.stop);
    denoise(pages, channels, guides, {of_moments.data(), integrals.size()}, solid_angle(basis.domain()), options);
    transform(pages, channels, c_from_moments, options.stop);
}

}  // namespace

bool denoise_pages(std::span<LightmapPage> pages, const BakeEncoding& encoding, const Guides& guides, StopFlag stop) {
    DenoiseOptions options;
    options.stop = stop;
    const PageChannels channels = encoding.page_channels();
    if (encoding.codec() == nullptr) {
        denoise(pages, channels, guides, {}, solid_angle(Domain::hemisphere), options);
        return true;
    }
    const LinearBasis* basis = encoding.page_encoder()->basis().linear();
    if (basis == nullptr) return false;
    if (encoding.fitted_last() != nullptr)
        denoise_moments(pages, channels, guides, *basis, options);
    else
        denoise(pages, channels, guides, basis->integrals(), solid_angle(basis->domain()), options);
    return true;
}

void fit_codec(std::vector<LightmapPage>& pages, const BakeEncoding& encoding, StopFlag stop) {
    if (const FittedBasis* basis = encoding.fitted_last()) pages = fit_pages(pages, *basis, stop);
}

}  // namespace lobelia
