// Solves texel by texel, in parallel, with totals that do not depend on the number of threads.
#include "bake/solve/solve.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <cmath>

#include "bake/place/texels.h"
#include "lobelia/sampling.h"

namespace lobelia {
namespace {

/// Normals at which a texel's coefficients are evaluated for the statistics: its own first, then some around it.
constexpr std::size_t k_normals = 16;

/// Solves for one texel's coefficients and evaluates their irradiance.
class TexelSolver {
  public:
    explicit TexelSolver(const BakeEncoding& encoding)
        : encoding_(encoding),
          around_(uniform_directions(Domain::hemisphere, Sequence::hammersley, k_normals - 1, 0)),
          normals_(k_normals),
          irradiances_(k_normals),
          c_(encoding.codec() == nullptr ? 0 : encoding.codec()->basis().size()),
          for_page_(encoding.page_channels().coefficients) {}

    /// Returns the page's coefficients; keeps the codec's own for irradiances().
    std::span<const Rgb> solve(std::span<const float> state) {
        if (encoding_.codec() == nullptr) return {};
        encoding_.page_encoder()->solve(state, for_page_);
        if (const FittedBasis* fitted = encoding_.fitted_last())
            fitted->fit(for_page_, c_);
        else
            c_ = for_page_;
        return for_page_;
    }

    /// Returns the codec's signed irradiance at the normal and around it.
    ColourView irradiances(Vec3 normal) {
        const Rotation tangent = tangent_from_world(normal);
        for (std::size_t j = 0; j < k_normals; ++j) {
            const Vec3 local = j == 0 ? Vec3{0, 0, 1} : direction_at(around_, j - 1);
            const Vec3 world = tangent[0] * local.x + tangent[1] * local.y + tangent[2] * local.z;
            set_entry(normals_.view(), j, encoding_.frame() == Frame::tangent ? local : world);
        }
        encoding_.codec()->evaluator().signed_irradiance(c_, normals_, irradiances_);
        return irradiances_;
    }

  private:
    const BakeEncoding& encoding_;
    Directions around_, normals_;
    Colours irradiances_;
    std::vector<Rgb> c_, for_page_;
};

void add_evaluations(ColourView irradiances, Rgb by_paths, SolveTotals& totals) {
    for (std::size_t j = 0; j < irradiances.size; ++j) {
        const float y = luminance(colour_at(irradiances, j));
        totals.evaluated += y;
        totals.evaluations += 1;
        if (y < 0) {
            totals.negative += 1;
            totals.negative_part -= y;
        }
    }
    const Rgb difference = colour_at(irradiances, 0) - by_paths;
    totals.codec_squared_error += luminance(difference) * luminance(difference);
}

void put(LightmapPage& page, std::size_t pixel, const PageChannels& channels, std::span<const Rgb> c,
         const ReceiverSummary& is) {
    const auto put_colour = [&](std::size_t first, Rgb colour) {
        page.planes[first][pixel] = colour.r;
        page.planes[first + 1][pixel] = colour.g;
        page.planes[first + 2][pixel] = colour.b;
    };
    for (std::size_t i = 0; i < c.size(); ++i) put_colour(channels.coefficient(i, 0), c[i]);
    put_colour(channels.irradiance(0), is.irradiance);
    page.planes[channels.error()][pixel] = std::isfinite(is.error) ? is.error : luminance(is.irradiance);
    page.validity[pixel] = is.validity;
}

}  // namespace

void SolveTotals::add(const SolveTotals& other) {
    texels += other.texels;
    invalid += other.invalid;
    buried += other.buried;
    squared_error += other.squared_error;
    irradiance += other.irradiance;
    back_faces += other.back_faces;
    codec_squared_error += other.codec_squared_error;
    evaluations += other.evaluations;
    negative += other.negative;
    evaluated += other.evaluated;
    negative_part += other.negative_part;
}

void SolveTotals::finish(BakeStatistics& statistics) const {
    if (texels == 0) return;
    const auto count = static_cast<double>(texels);
    const double mean = irradiance / count;
    const auto over = [](double a, double b) { return b > 0 ? a / b : 0; };
    statistics.invalid_texels = invalid;
    statistics.buried_texels = buried;
    statistics.mean_error = over(std::sqrt(squared_error / count), mean);
    statistics.back_face_share = over(back_faces, static_cast<double>(texels - buried));
    statistics.codec_error = over(std::sqrt(codec_squared_error / count), mean);
    statistics.negative_share = over(static_cast<double>(negative), static_cast<double>(evaluations));
    statistics.ringing = over(negative_part, std::abs(evaluated));
}

void solve_onto(std::span<LightmapPage> pages, const Atlas& atlas, const TexelMap& map, const SolveTexels& solved,
                const BakeEncoding& encoding, std::uint32_t samples_per_pass, SolveTotals& totals) {
    const PageChannels channels = encoding.page_channels();
    const StateLayout layout = encoding.states();
    const auto solve_range = [&](const tbb::blocked_range<std::size_t>& range, SolveTotals sum) {
        TexelSolver solver(encoding);
        for (std::size_t k = range.begin(); k < range.end(); ++k) {
            // Solve for the texel, and put it onto its page.
            solved.stop.check();
            const auto state = solved.states.subspan(k * layout.floats(), layout.floats());
            const Receiver& receiver = solved.receivers[k];
            const ReceiverSummary is = summary(layout.record(state), samples_per_pass);
            const CoveredTexel at = map.texels[solved.texels[k]];
            LightmapPage& page = pages[at.page];
            const std::size_t pixel = at.y * page.width + at.x;
            page.chart[pixel] = atlas.chart_of_triangle()[map.triangle[solved.texels[k]]] + 1;
            put(page, pixel, channels, solver.solve(layout.encoder(state)), is);

            // Add it to the statistics.
            sum.texels += 1;
            const bool buried = receiver.buried && is.validity < 0.5f;
            sum.buried += buried;
            sum.back_faces += buried ? 0 : 1 - is.validity;
            if (is.validity < 0.5f) {
                sum.invalid += 1;
                continue;
            }
            const double error = page.planes[channels.error()][pixel];
            sum.squared_error += error * error;
            sum.irradiance += luminance(is.irradiance);
            if (encoding.codec() != nullptr) add_evaluations(solver.irradiances(receiver.normal), is.irradiance, sum);
        }
        return sum;
    };
    const auto both = [](SolveTotals a, const SolveTotals& b) {
        a.add(b);
        return a;
    };
    constexpr std::size_t grain = 1024;
    totals.add(tbb::parallel_deterministic_reduce(tbb::blocked_range<std::size_t>(0, solved.texels.size(), grain),
                                                  SolveTotals{}, solve_range, both));
}

}  // namespace lobelia
