#include "measure/prefilter.h"

#include <tbb/parallel_for.h>

#include <atomic>
#include <bit>
#include <cmath>
#include <mutex>
#include <optional>

#include "bake/place/texels.h"
#include "core/math/ggx.h"
#include "core/sample/directions.h"
#include "lobelia/environment.h"
#include "lobelia/sampling.h"

namespace lobelia {
namespace {

constexpr std::size_t k_checked_directions = 96;

/// A sample of the reflection about z,.
struct LobeSample {
    Vec3 direction;
    double level = 0;  ///< of the environment's pyramid
};

/// Directions l about z with density D / 4: half vectors with density D (n.h), n = v = z.
std::vector<LobeSample> lobe_samples(double roughness, std::size_t count, double texels) {
    const double alpha = std::max(roughness * roughness, static_cast<double>(ggx::k_least_alpha));
    std::vector<LobeSample> samples;
    for (std::size_t i = 0; i < count; ++i) {
        const double a = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
        const double phi = 2 * k_pi * radical_inverse_2(static_cast<std::uint32_t>(i));
        const double cos2 = (1 - a) / (1 + (alpha * alpha - 1) * a), cosine = 2 * cos2 - 1;
        if (cosine <= 0) continue;
        const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
        LobeSample s;
        s.direction = {static_cast<float>(sine * std::cos(phi)), static_cast<float>(sine * std::sin(phi)),
                       static_cast<float>(cosine)};
        // The solid angle that the sample stands for, in texels of the environment, four texels a sample.
        const double d = alpha * alpha / (k_pi * std::pow(cos2 * (alpha * alpha - 1) + 1, 2));
        const double solid_angle = 4 / (d * static_cast<double>(count));
        s.level = std::max(0.0, 0.5 * std::log2(solid_angle * texels / (4 * k_pi)) + 1);
        samples.push_back(s);
    }
    return samples;
}

/// An environment and ever smaller copies of it, energy kept.
class Pyramid {
  public:
    explicit Pyramid(const Image& environment) {
        levels_.push_back(environment);
        while (levels_.back().width > 4 && levels_.back().height > 2)
            levels_.push_back(resize(levels_.back(), {levels_.back().width / 2, levels_.back().height / 2}));
    }
    [[nodiscard]] double texels() const { return static_cast<double>(lat_long(levels_.front()).size()); }
    /// Bilinear within a level, linear between levels.
    [[nodiscard]] Rgb at(Vec3 direction, double level) const {
        const double clamped = std::min(level, static_cast<double>(levels_.size() - 1));
        const auto low = static_cast<std::size_t>(clamped);
        const auto part = static_cast<float>(clamped - static_cast<double>(low));
        const Rgb a = bilinear(levels_[low], direction);
        return part == 0 ? a : a * (1 - part) + bilinear(levels_[low + 1], direction) * part;
    }

  private:
    static Rgb bilinear(const Image& image, Vec3 direction) {
        const auto [u, v] = LatLong::position(direction);
        const double x = u * static_cast<double>(image.width) - 0.5, y = v * static_cast<double>(image.height) - 0.5;
        const double x0 = std::floor(x), y0 = std::floor(y);
        const auto fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
        const auto column = [&](double c) {
            const auto w = static_cast<long>(image.width);
            return static_cast<std::size_t>((static_cast<long>(c) + w) % w);
        };
        const auto row = [&](double r) {
            return static_cast<std::size_t>(std::clamp(r, 0.0, static_cast<double>(image.height - 1)));
        };
        const auto texel = [&](double c, double r) { return image.pixels[row(r) * image.width + column(c)]; };
        return (texel(x0, y0) * (1 - fx) + texel(x0 + 1, y0) * fx) * (1 - fy) +
               (texel(x0, y0 + 1) * (1 - fx) + texel(x0 + 1, y0 + 1) * fx) * fy;
    }

    std::vector<Image> levels_;
};

/// The texels of an environment as one light each, for sums over all of them: structure of arrays.
class TexelLights {
  public:
    explicit TexelLights(const Image& environment) {
        const LatLong grid = lat_long(environment);
        for (auto* plane : {&x_, &y_, &z_, &r_, &g_, &b_, &w_}) plane->resize(grid.size());
        for (std::size_t i = 0; i < grid.size(); ++i) {
            const Vec3 d = grid.direction(i);
            const auto solid_angle = static_cast<float>(grid.solid_angle(i / grid.width));
            const Rgb L = environment.pixels[i] * solid_angle;
            x_[i] = d.x, y_[i] = d.y, z_[i] = d.z;
            r_[i] = L.r, g_[i] = L.g, b_[i] = L.b, w_[i] = solid_angle;
        }
    }

    /// The sum of D(h) (n.l) L(l) over that of D(h) (n.l), for n = v = `n`.
    [[nodiscard]] Rgb mean(Vec3 n, double roughness) const {
        const auto alpha2 = static_cast<float>(std::pow(roughness, 4));
        std::array<double, 4> sum{};
        for (std::size_t begin = 0; begin < x_.size(); begin += k_block) {
            const std::size_t end = std::min(begin + k_block, x_.size());
            // Floats within a block, so that the loop becomes vectors.
            float r = 0, g = 0, b = 0, w = 0;
            for (std::size_t i = begin; i < end; ++i) {
                const float cosine = n.x * x_[i] + n.y * y_[i] + n.z * z_[i];
                const float d = 1 + 0.5f * (1 + cosine) * (alpha2 - 1);
                const float weight = std::max(cosine, 0.0f) / (d * d);
                r += weight * r_[i];
                g += weight * g_[i];
                b += weight * b_[i];
                w += weight * w_[i];
            }
            sum[0] += static_cast<double>(r);
            sum[1] += static_cast<double>(g);
            sum[2] += static_cast<double>(b);
            sum[3] += static_cast<double>(w);
        }
        const auto share = [&](std::size_t k) { return static_cast<float>(sum[k] / sum[3]); };
        return {share(0), share(1), share(2)};
    }

  private:
    static constexpr std::size_t k_block = 512;
    std::vector<float> x_, y_, z_, r_, g_, b_, w_;
};

/// Columns of an environment whose texels are an eighth as wide as the reflection, 2 alpha: a sum over them is exact
/// but for the texels' own width.
double columns_for(double roughness) { return 8 * k_pi / (roughness * roughness); }
/// More columns than these are sampled: a sum would take too long.
constexpr double k_most_columns = 700;

/// The environment with about `columns` columns, or itself if it has fewer.
Image reduced_to(const Image& environment, double columns) {
    const auto wanted = static_cast<std::size_t>(std::ceil(columns));
    if (environment.width <= wanted) return environment;
    return resize(environment, {wanted, std::max<std::size_t>(1, wanted * environment.height / environment.width)});
}

/// Mean over samples turned to `direction`; `read(direction, level)` gives radiance.
template <class Read>
Rgb lobe_mean(const std::vector<LobeSample>& samples, Vec3 direction, const Read& read) {
    const Axes axes(tangent_from_world(direction));
    double r = 0, g = 0, b = 0, weights = 0;
    for (const LobeSample& s : samples) {
        const auto weight = static_cast<double>(s.direction.z);
        const Rgb L = read(axes.world(s.direction), s.level);
        r += weight * static_cast<double>(L.r);
        g += weight * static_cast<double>(L.g);
        b += weight * static_cast<double>(L.b);
        weights += weight;
    }
    return {static_cast<float>(r / weights), static_cast<float>(g / weights), static_cast<float>(b / weights)};
}

/// The integral in any direction: the sum over all texels of the environment where they are narrower than the
/// reflection, else many samples of them.
class LobeReference {
  public:
    LobeReference(const Image& environment, double roughness, std::size_t count = 65536)
        : environment_(environment), roughness_(roughness) {
        if (roughness == 0)
            pyramid_.emplace(environment);
        else if (columns_for(roughness) <= static_cast<double>(environment.width))
            lights_.emplace(environment);
        else
            samples_ = lobe_samples(roughness, count, 1);
    }
    [[nodiscard]] Rgb at(Vec3 direction) const {
        if (pyramid_) return pyramid_->at(direction, 0);
        if (lights_) return lights_->mean(direction, roughness_);
        const LatLong grid = lat_long(environment_);
        return lobe_mean(samples_, direction, [&](Vec3 w, double) { return environment_.pixels[grid.index(w)]; });
    }

  private:
    const Image& environment_;
    double roughness_;
    std::optional<Pyramid> pyramid_;
    std::optional<TexelLights> lights_;
    std::vector<LobeSample> samples_;
};

Vec3 mirrored(CubeConvention convention, Vec3 w) {
    return convention == CubeConvention::three ? Vec3{-w.x, w.y, w.z} : w;
}

/// A place on a face: s and t in [-1, 1].
struct FacePlace {
    std::size_t face = 0;
    float s = 0, t = 0;
};
/// A face's centre, and the steps of 1 in s and t there.
struct FaceAxes {
    Vec3 centre, right, down;
    explicit FaceAxes(std::size_t face)
        : centre(cube_direction(face, 0, 0)),
          right(cube_direction(face, 1, 0) * std::sqrt(2.0f) - centre),
          down(cube_direction(face, 0, 1) * std::sqrt(2.0f) - centre) {}
};
FacePlace place_on_cube(Vec3 w) {
    const std::array<float, 3> d = {w.x, w.y, w.z};
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k)
        if (std::abs(d[k]) > std::abs(d[axis])) axis = k;
    const std::size_t face = 2 * axis + (d[axis] < 0 ? 1 : 0);
    const FaceAxes axes(face);
    const Vec3 at = w * (1 / std::abs(d[axis]));
    return {face, dot(at, axes.right), dot(at, axes.down)};
}

/// What the level gives in a direction: bilinear, across the edges of faces too, as hardware does.
Rgb read_cube(const CubeLevel& level, Vec3 w) {
    const FacePlace place = place_on_cube(w);
    const FaceAxes axes(place.face);
    const auto n = static_cast<float>(level.size);
    const auto index = [&](float at) {
        return static_cast<std::size_t>(std::clamp(std::floor(0.5f * (at + 1) * n), 0.0f, n - 1));
    };
    const auto texel = [&](float i, float j) {
        FacePlace of{place.face, 2 * (i + 0.5f) / n - 1, 2 * (j + 0.5f) / n - 1};
        if (std::max(std::abs(of.s), std::abs(of.t)) > 1)
            of = place_on_cube(axes.centre + axes.right * of.s + axes.down * of.t);
        return level.texels[(of.face * level.size + index(of.t)) * level.size + index(of.s)];
    };
    const float x = 0.5f * (place.s + 1) * n - 0.5f, y = 0.5f * (place.t + 1) * n - 0.5f;
    const float x0 = std::floor(x), y0 = std::floor(y), fx = x - x0, fy = y - y0;
    return (texel(x0, y0) * (1 - fx) + texel(x0 + 1, y0) * fx) * (1 - fy) +
           (texel(x0, y0 + 1) * (1 - fx) + texel(x0 + 1, y0 + 1) * fx) * fy;
}

double error_of(const CubeLevel& level, const Image& environment, CubeConvention convention) {
    const Directions directions = uniform_directions(Domain::sphere, Sequence::hammersley, k_checked_directions, 0);
    const LobeReference reference(environment, level.roughness);
    double off = 0, all = 0;
    std::mutex mutex;
    tbb::parallel_for(std::size_t{0}, k_checked_directions, [&](std::size_t i) {
        const Vec3 w = direction_at(directions, i);
        const Rgb wanted = reference.at(w), found = read_cube(level, mirrored(convention, w));
        const std::scoped_lock lock(mutex);
        for (std::size_t k = 0; k < 3; ++k) {
            const double a = (&wanted.r)[k], b = (&found.r)[k];
            off += (a - b) * (a - b);
            all += a * a;
        }
    });
    return all > 0 ? std::sqrt(off / all) : 0;
}

Status check(const Image& environment, const PrefilterOptions& options) {
    if (environment.pixels.empty()) return Error{"the environment has no texels"};
    if (!std::has_single_bit(options.size)) return Error{"the size of a face must be a power of two"};
    const auto most = static_cast<std::size_t>(std::bit_width(options.size));
    if (options.levels < 2 || options.levels > most)
        return Error{"the number of levels must be from 2 to " + std::to_string(most) + " for this size"};
    return Done{};
}

}  // namespace

double roughness_of_level(CubeConvention convention, std::size_t level, std::size_t levels) {
    const double along = levels < 2 ? 0 : static_cast<double>(level) / static_cast<double>(levels - 1);
    // The inverse of along = r (2 - r).
    return convention == CubeConvention::filament ? 1 - std::sqrt(1 - along) : along;
}

Vec3 cube_direction(std::size_t face, double s, double t) {
    const std::array<std::array<double, 3>, 6> places = {
        {{1, -t, -s}, {-1, -t, s}, {s, 1, t}, {s, -1, -t}, {s, -t, 1}, {-s, -t, -1}}};
    const auto& [x, y, z] = places[face];
    return normalize(Vec3{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
}

Rgb prefiltered_radiance(const Image& environment, Vec3 direction, double roughness, std::size_t count) {
    return LobeReference(environment, roughness, count).at(direction);
}

Result<std::vector<CubeLevel>> prefilter(const Image& environment, const PrefilterOptions& options) {
    if (Status status = check(environment, options); !status) return status.error();
    const Pyramid pyramid(environment);
    std::vector<CubeLevel> levels;
    std::size_t rows = 0;
    for (std::size_t i = 0; i < options.levels; ++i) {
        levels.push_back({options.size >> i, roughness_of_level(options.convention, i, options.levels), {}, 0});
        rows += 6 * levels.back().size;
    }
    std::atomic<std::size_t> done = 0;
    std::mutex reporting;
    auto status = unless_stopped([&]() -> Status {
        for (CubeLevel& level : levels) {
            level.texels.resize(6 * level.size * level.size);
            const bool sums = level.roughness > 0 && columns_for(level.roughness) <= k_most_columns;
            std::optional<TexelLights> lights;
            if (sums) lights.emplace(reduced_to(environment, columns_for(level.roughness)));
            const auto samples =
                sums ? std::vector<LobeSample>() : lobe_samples(level.roughness, options.samples, pyramid.texels());
            // Level 0 is read at the spacing of its texels.
            const double texels = 6 * static_cast<double>(level.size) * static_cast<double>(level.size);
            const double sharp = std::max(0.0, 0.5 * std::log2(pyramid.texels() / texels));
            tbb::parallel_for(std::size_t{0}, 6 * level.size, [&](std::size_t row) {
                options.stop.check();
                const auto place = [&](std::size_t k) {
                    return 2 * (static_cast<double>(k) + 0.5) / static_cast<double>(level.size) - 1;
                };
                for (std::size_t x = 0; x < level.size; ++x) {
                    const Vec3 w = mirrored(options.convention,
                                            cube_direction(row / level.size, place(x), place(row % level.size)));
                    Rgb& texel = level.texels[row * level.size + x];
                    if (level.roughness == 0)
                        texel = pyramid.at(w, sharp);
                    else if (sums)
                        texel = lights->mean(w, level.roughness);
                    else
                        texel = lobe_mean(samples, w, [&](Vec3 l, double at) { return pyramid.at(l, at); });
                }
                ++done;
                if (!options.progress || !reporting.try_lock()) return;
                options.progress(static_cast<double>(done) / static_cast<double>(rows));
                reporting.unlock();
            });
            level.error = error_of(level, environment, options.convention);
        }
        return Done{};
    });
    return status ? Result<std::vector<CubeLevel>>(std::move(levels)) : status.error();
}

std::vector<std::array<float, 2>> split_sum_table(std::size_t size) {
    std::vector<std::array<float, 2>> table(size * size);
    tbb::parallel_for(std::size_t{0}, table.size(), [&](std::size_t i) {
        const auto place = [&](std::size_t k) { return (static_cast<float>(k) + 0.5f) / static_cast<float>(size); };
        const float roughness = place(i / size);
        const auto lobe = ggx::lobe_by_rays(ggx::make_view(place(i % size), roughness * roughness), 1024);
        table[i] = {lobe.albedo - lobe.fresnel, lobe.fresnel};
    });
    return table;
}

}  // namespace lobelia
