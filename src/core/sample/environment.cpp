// Latitude-longitude environments: which texel looks where, samples from them, resizing.
#include "lobelia/environment.h"

#include <bit>
#include <numeric>

#include "core/math/kernels.h"
#include "lobelia/sampling.h"

namespace lobelia {
namespace {

/// The share of each target cell that each source cell covers, cells given by their edges (ascending, same ends).
struct Overlap {
    std::size_t target = 0, source = 0;
    double share = 0;
};

std::vector<Overlap> overlaps(const std::vector<double>& target_edges, const std::vector<double>& source_edges) {
    std::vector<Overlap> result;
    std::size_t s = 0;
    for (std::size_t t = 0; t + 1 < target_edges.size(); ++t) {
        const double low = target_edges[t], high = target_edges[t + 1];
        while (s > 0 && source_edges[s] > low) --s;
        while (s + 2 < source_edges.size() && source_edges[s + 1] <= low) ++s;
        for (std::size_t i = s; i + 1 < source_edges.size() && source_edges[i] < high; ++i) {
            const double covered = std::min(high, source_edges[i + 1]) - std::max(low, source_edges[i]);
            if (covered > 0) result.push_back({t, i, covered / (high - low)});
        }
    }
    return result;
}

std::vector<double> longitude_edges(std::size_t width) {
    std::vector<double> edges(width + 1);
    for (std::size_t i = 0; i <= width; ++i) edges[i] = static_cast<double>(i) / static_cast<double>(width);
    return edges;
}

/// Edges in 1 - cos(phi), in which equal steps are equal solid angles.
std::vector<double> latitude_edges(std::size_t height) {
    std::vector<double> edges(height + 1);
    for (std::size_t i = 0; i <= height; ++i)
        edges[i] = 1 - std::cos(k_pi * static_cast<double>(i) / static_cast<double>(height));
    return edges;
}

/// Place of cell (x, y) along the Hilbert curve through a square of `side` = 2^k cells.
std::uint64_t hilbert_index(std::uint32_t side, std::uint32_t x, std::uint32_t y) {
    std::uint64_t index = 0;
    for (std::uint32_t s = side / 2; s > 0; s /= 2) {
        const std::uint32_t right = (x & s) ? 1 : 0, lower = (y & s) ? 1 : 0;
        index += static_cast<std::uint64_t>(s) * s * ((3 * right) ^ lower);
        // Turn the quadrant so that its curve starts where the last one ended.
        if (lower == 0) {
            if (right == 1) {
                x = side - 1 - x;
                y = side - 1 - y;
            }
            std::swap(x, y);
        }
    }
    return index;
}

void check_pixels(const Image& image, SourcePlace place = SourcePlace::here()) {
    check_equal("pixels of an image", image.pixels.size(), image.width * image.height, place);
}

/// The named texels as samples, in the order given.
Samples samples_of(const Image& environment, Domain domain, const std::vector<std::uint32_t>& texels) {
    check_pixels(environment);
    const LatLong grid = lat_long(environment);
    const Directions directions = grid.directions(domain);
    const std::vector<float> solid_angles = grid.solid_angles();
    Samples samples(texels.size());
    for (std::size_t i = 0; i < texels.size(); ++i)
        samples.set(i, {direction_at(directions, texels[i]), environment.pixels[texels[i]], solid_angles[texels[i]]});
    return samples;
}

Vec3 direction_from_angles(double sin_theta, double cos_theta, double sin_phi, double cos_phi) {
    return {static_cast<float>(sin_phi * sin_theta), static_cast<float>(cos_phi),
            static_cast<float>(-sin_phi * cos_theta)};
}

}  // namespace

Vec3 LatLong::direction(double u, double v) {
    const double theta = k_pi * (2 * u - 1), phi = k_pi * v;
    return direction_from_angles(std::sin(theta), std::cos(theta), std::sin(phi), std::cos(phi));
}

LatLong::Position LatLong::position(Vec3 d) {
    return {(1 + std::atan2(static_cast<double>(d.x), static_cast<double>(-d.z)) / k_pi) / 2,
            std::acos(std::clamp(static_cast<double>(d.y), -1.0, 1.0)) / k_pi};
}

Vec3 LatLong::direction(std::size_t index) const {
    check_grid(*this);
    return direction((static_cast<double>(index % width) + 0.5) / static_cast<double>(width),
                     (static_cast<double>(index / width) + 0.5) / static_cast<double>(height));
}

std::size_t LatLong::index(Vec3 d) const {
    check_grid(*this);
    const Position p = position(d);
    const auto cell = [](double t, std::size_t n) {
        return std::min(static_cast<std::size_t>(std::max(0.0, t * static_cast<double>(n))), n - 1);
    };
    return cell(p.v, height) * width + cell(p.u, width);
}

double LatLong::solid_angle(std::size_t y) const {
    check_grid(*this);
    const double step = k_pi / static_cast<double>(height);
    const double band = std::cos(static_cast<double>(y) * step) - std::cos(static_cast<double>(y + 1) * step);
    return 2 * k_pi / static_cast<double>(width) * band;
}

Directions LatLong::directions(Domain domain) const {
    // Tabulate the azimuths once: a grid has far more texels than columns.
    std::vector<double> sin_theta(width), cos_theta(width);
    for (std::size_t x = 0; x < width; ++x) {
        const double theta = k_pi * (2 * (static_cast<double>(x) + 0.5) / static_cast<double>(width) - 1);
        sin_theta[x] = std::sin(theta);
        cos_theta[x] = std::cos(theta);
    }
    Directions result(size());
    for (std::size_t y = 0; y < height; ++y) {
        const double phi = k_pi * (static_cast<double>(y) + 0.5) / static_cast<double>(height);
        const double sin_phi = std::sin(phi), cos_phi = std::cos(phi);
        for (std::size_t x = 0; x < width; ++x)
            set_entry(result.view(), y * width + x,
                      domain_from_world(domain, direction_from_angles(sin_theta[x], cos_theta[x], sin_phi, cos_phi)));
    }
    return result;
}

std::vector<float> LatLong::solid_angles() const {
    std::vector<float> result(size());
    for (std::size_t y = 0; y < height; ++y)
        std::fill_n(result.begin() + static_cast<std::ptrdiff_t>(y * width), width, static_cast<float>(solid_angle(y)));
    return result;
}

Vec3 domain_from_world(Domain domain, Vec3 d) { return domain == Domain::sphere ? d : Vec3{d.x, -d.z, d.y}; }

Vec3 world_from_domain(Domain domain, Vec3 d) { return domain == Domain::sphere ? d : Vec3{d.x, d.z, -d.y}; }

Image resize(const Image& environment, LatLong target) {
    if (lat_long(environment) == target) return environment;
    check_grid(lat_long(environment));
    check_grid(target);
    check_pixels(environment);
    const auto columns = overlaps(longitude_edges(target.width), longitude_edges(environment.width));
    const auto rows = overlaps(latitude_edges(target.height), latitude_edges(environment.height));

    // Add up, for each target row, the source rows that it covers, each first reduced to the target's columns.
    Image result(target.width, target.height);
    std::vector<double> sums(3 * target.width);
    const auto store = [&](std::size_t y) {
        for (std::size_t x = 0; x < target.width; ++x)
            result.at(x, y) = {static_cast<float>(sums[3 * x]), static_cast<float>(sums[3 * x + 1]),
                               static_cast<float>(sums[3 * x + 2])};
        std::fill(sums.begin(), sums.end(), 0.0);
    };
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const Rgb* source = &environment.at(0, rows[i].source);
        for (const Overlap& column : columns) {
            const double share = column.share * rows[i].share;
            const Rgb& pixel = source[column.source];
            double* sum = &sums[3 * column.target];
            sum[0] += share * pixel.r;
            sum[1] += share * pixel.g;
            sum[2] += share * pixel.b;
        }
        if (i + 1 == rows.size() || rows[i + 1].target != rows[i].target) store(rows[i].target);
    }
    return result;
}

LatLong reduced_grid(LatLong grid, std::size_t most_texels) {
    check_range("most texels", most_texels, 1, SIZE_MAX);
    if (grid.size() <= most_texels) return grid;
    const double factor = std::sqrt(static_cast<double>(grid.size()) / static_cast<double>(most_texels));
    // Prefer a whole-number reduction: then every target texel averages whole source texels.
    const auto whole = static_cast<std::size_t>(std::ceil(factor));
    if (grid.width % whole == 0 && grid.height % whole == 0) return {grid.width / whole, grid.height / whole};
    const auto scaled = [&](std::size_t n) {
        return std::max<std::size_t>(1, static_cast<std::size_t>(static_cast<double>(n) / factor));
    };
    // A strip of one row or column cannot shrink in proportion: it loses length alone.
    const std::size_t width = std::min(scaled(grid.width), most_texels);
    return {width, std::min(scaled(grid.height), most_texels / width)};
}

std::vector<std::uint32_t> LatLong::texels_of(Domain domain) const {
    // The hemisphere sees the rows whose centres lie above the horizon: whole rows, from the top.
    const std::size_t rows = domain == Domain::sphere ? height : height / 2;
    std::vector<std::uint32_t> texels(rows * width);
    std::iota(texels.begin(), texels.end(), 0u);
    return texels;
}

Samples texel_samples(const Image& environment, Domain domain) {
    return samples_of(environment, domain, lat_long(environment).texels_of(domain));
}

Samples shuffled_texel_samples(const Image& environment, Domain domain, std::uint32_t seed) {
    const LatLong grid = lat_long(environment);
    std::vector<std::uint32_t> texels = grid.texels_of(domain);

    // Line the texels up along the curve, so that neighbours in the line are neighbours on the sphere.
    const std::uint32_t side = static_cast<std::uint32_t>(std::bit_ceil(std::max(grid.width, grid.height)));
    std::vector<std::uint64_t> key(grid.size());
    for (std::uint32_t texel : texels)
        key[texel] = hilbert_index(side, static_cast<std::uint32_t>(texel % grid.width),
                                   static_cast<std::uint32_t>(texel / grid.width));
    std::sort(texels.begin(), texels.end(), [&](std::uint32_t a, std::uint32_t b) { return key[a] < key[b]; });

    const auto order = spread_order(texels.size(), seed);
    std::vector<std::uint32_t> visited(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) visited[i] = texels[order[i]];
    return samples_of(environment, domain, visited);
}

Samples directed_samples(const Image& environment, DirectionView directions, Domain domain) {
    check_pixels(environment);
    const LatLong grid = lat_long(environment);
    const auto share = static_cast<float>(lobelia::solid_angle(domain) / static_cast<double>(directions.size));
    Samples samples(directions.size);
    for (std::size_t i = 0; i < directions.size; ++i) {
        const Vec3 d = direction_at(directions, i);
        samples.set(i, {d, environment.pixels[grid.index(world_from_domain(domain, d))], share});
    }
    return samples;
}

Colours radiance_of(const Image& image) {
    Colours result(image.pixels.size());
    for (std::size_t i = 0; i < image.pixels.size(); ++i) set_entry(result.view(), i, image.pixels[i]);
    return result;
}

Rgb mean_radiance(const Image& environment) {
    const Image whole = resize(environment, {1, 1});
    return whole.pixels[0];
}

void irradiance_sum(SampleView samples, DirectionView normals, MutableColourView out) {
    check_equal("colours for the normals", out.size, normals.size);
    kernels::irradiance_sum(samples, normals, out);
}

void irradiance_sums(SampleView samples, DirectionView normals, MutableColourView out, MutableColourView opposite) {
    check_equal("colours for the normals", out.size, normals.size);
    check_equal("colours for the opposite normals", opposite.size, normals.size);
    kernels::irradiance_sums(samples, normals, out, opposite);
}

}  // namespace lobelia
