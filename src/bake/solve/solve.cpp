// Solving texel by texel, in parallel, with totals that do not depend on the number of threads.
#include "bake/solve/solve.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <cmath>

#include "bake/place/texels.h"
#include "lobelia/sampling.h"

namespace lobelia {
namespace {

/// Normals at which a texel's coefficients are read to judge them: its own first, then some about it.
constexpr std::size_t k_readings = 16;

class Reader {
  public:
    explicit Reader(const SolveOptions& options)
        : options_(options),
          around_(uniform_directions(Domain::hemisphere, Sequence::hammersley, k_readings - 1, 0)),
          normals_(k_readings),
          readings_(k_readings),
          c_(options.codec == nullptr ? 0 : options.codec->basis().size()),
          for_page_(options.pages == nullptr ? 0 : options.pages->basis().size()) {}

    /// The coefficients for the page; the codec's own are kept for read().
    std::span<const Rgb> solve(std::span<const float> state) {
        options_.pages->solve(state, for_page_);
        if (options_.pages == options_.codec->encoder().get())
            c_ = for_page_;
        else
            options_.codec->basis().fitted()->fit(for_page_, c_);
        return for_page_;
    }

    /// Signed irradiance by the codec at the normal and around it.
    ColourView read(Vec3 normal) {
        const Rotation tangent = tangent_from_world(normal);
        for (std::size_t j = 0; j < k_readings; ++j) {
            const Vec3 local = j == 0 ? Vec3{0, 0, 1} : direction_at(around_, j - 1);
            const Vec3 world = tangent[0] * local.x + tangent[1] * local.y + tangent[2] * local.z;
            set_entry(normals_.view(), j, options_.in_tangent_frame ? local : world);
        }
        options_.codec->evaluator().signed_irradiance(c_, normals_, readings_);
        return readings_;
    }

  private:
    const SolveOptions& options_;
    Directions around_, normals_;
    Colours readings_;
    std::vector<Rgb> c_, for_page_;
};

void count_readings(ColourView readings, Rgb by_paths, SolveTotals& totals) {
    for (std::size_t j = 0; j < readings.size; ++j) {
        const float y = luminance(colour_at(readings, j));
        totals.reading += y;
        totals.readings += 1;
        if (y < 0) {
            totals.negative += 1;
            totals.negative_part -= y;
        }
    }
    const Rgb off = colour_at(readings, 0) - by_paths;
    totals.codec_squared_error += luminance(off) * luminance(off);
}

void put(Page& page, std::size_t pixel, const PageLayout& layout, std::span<const Rgb> c, const SiteSummary& is) {
    const auto put_colour = [&](std::size_t first, Rgb colour) {
        page.planes[first][pixel] = colour.r;
        page.planes[first + 1][pixel] = colour.g;
        page.planes[first + 2][pixel] = colour.b;
    };
    for (std::size_t i = 0; i < c.size(); ++i) put_colour(layout.coefficient(i, 0), c[i]);
    put_colour(layout.irradiance(0), is.irradiance);
    page.planes[layout.error()][pixel] = std::isfinite(is.error) ? is.error : luminance(is.irradiance);
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
    readings += other.readings;
    negative += other.negative;
    reading += other.reading;
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
    statistics.negative_share = over(static_cast<double>(negative), static_cast<double>(readings));
    statistics.ringing = over(negative_part, std::abs(reading));
}

void solve_onto(std::span<Page> pages, const TexelMap& map, std::span<const std::uint32_t> texels,
                std::span<const float> states, const SiteLayout& layout, const SolveOptions& options,
                std::span<const Site> sites, const Atlas& atlas, SolveTotals& totals) {
    const PageLayout planes{options.pages == nullptr ? 0 : options.pages->basis().size()};
    const auto solve_range = [&](const tbb::blocked_range<std::size_t>& range, SolveTotals sum) {
        Reader reader(options);
        for (std::size_t k = range.begin(); k < range.end(); ++k) {
            const auto state = states.subspan(k * layout.floats(), layout.floats());
            const SiteSummary is = summary(layout.record(state), options.samples_per_pass);
            const CoveredTexel at = map.texels[texels[k]];
            Page& page = pages[at.page];
            const std::size_t pixel = at.y * page.width + at.x;
            page.chart[pixel] = atlas.chart_of_triangle()[map.triangle[texels[k]]] + 1;
            put(page, pixel, planes,
                options.codec == nullptr ? std::span<const Rgb>() : reader.solve(layout.encoder(state)), is);

            sum.texels += 1;
            const bool buried = sites[k].buried && is.validity < 0.5f;
            sum.buried += buried;
            sum.back_faces += buried ? 0 : 1 - is.validity;
            if (is.validity < 0.5f) {
                sum.invalid += 1;
                continue;
            }
            const double error = page.planes[planes.error()][pixel];
            sum.squared_error += error * error;
            sum.irradiance += luminance(is.irradiance);
            if (options.codec != nullptr) count_readings(reader.read(sites[k].normal), is.irradiance, sum);
        }
        return sum;
    };
    const auto both = [](SolveTotals a, const SolveTotals& b) {
        a.add(b);
        return a;
    };
    constexpr std::size_t grain = 1024;
    totals.add(tbb::parallel_deterministic_reduce(tbb::blocked_range<std::size_t>(0, texels.size(), grain),
                                                  SolveTotals{}, solve_range, both));
}

}  // namespace lobelia
