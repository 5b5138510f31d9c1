// Point sequences in the unit square, their maps onto the sphere and the hemisphere, shuffling, discrete sampling.
// Halton (1960), Hammersley (1960), Roberts (2018), Sobol (1967), Owen (1995), Burley (2020), Vose (1991).
#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <span>
#include <string_view>
#include <vector>

#include "lobelia/sample.h"

namespace lobelia {

/// A point of the unit square [0, 1)^2.
struct Point2 {
    double a = 0, b = 0;
};

/// random: independent. stratified: one jittered point per cell of a near-square grid, cells in random order.
/// hammersley: (i / N, radical inverse base 2); ordered, so shuffle it for encoders that correct an estimate sample by
/// sample. halton: radical inverses base 2 and 3 of i + 1. r2: Roberts's additive recurrence. sobol: the first two
/// Sobol dimensions, Owen-scrambled by hashing. The seed does not change hammersley and halton, and rotates r2.
enum class Sequence { random, stratified, hammersley, halton, r2, sobol };

inline constexpr std::array k_sequences = {Sequence::random, Sequence::stratified, Sequence::hammersley,
                                           Sequence::halton, Sequence::r2,         Sequence::sobol};

[[nodiscard]] std::string_view sequence_name(Sequence sequence);
[[nodiscard]] std::optional<Sequence> sequence_from_name(std::string_view name);

/// Returns the first `count` points.
[[nodiscard]] std::vector<Point2> sequence_points(Sequence sequence, std::size_t count, std::uint32_t seed);

/// Returns the radical inverse of `i` in base 2: its bits mirrored about the point, in [0, 1).
[[nodiscard]] double radical_inverse_2(std::uint32_t i);

/// Uniform directions on the sphere: z = 1 - 2a, azimuth 2 pi b about the z axis. pdf 1 / (4 pi).
struct UniformSphere {
    static constexpr Domain domain = Domain::sphere;
    [[nodiscard]] static Vec3 sample(Point2 p);
    [[nodiscard]] static double pdf(Vec3 direction);
    [[nodiscard]] static Point2 inverse(Vec3 direction);
};

/// Uniform directions on the hemisphere z >= 0: z = 1 - a. pdf 1 / (2 pi), 0 below.
struct UniformHemisphere {
    static constexpr Domain domain = Domain::hemisphere;
    [[nodiscard]] static Vec3 sample(Point2 p);
    [[nodiscard]] static double pdf(Vec3 direction);
    [[nodiscard]] static Point2 inverse(Vec3 direction);
};

/// Cosine-weighted directions on the hemisphere z >= 0: z = sqrt(1 - a). pdf z / pi, 0 below.
struct CosineHemisphere {
    static constexpr Domain domain = Domain::hemisphere;
    [[nodiscard]] static Vec3 sample(Point2 p);
    [[nodiscard]] static double pdf(Vec3 direction);
    [[nodiscard]] static Point2 inverse(Vec3 direction);
};

/// Returns `count` uniform directions over the domain.
[[nodiscard]] Directions uniform_directions(Domain domain, Sequence sequence, std::size_t count, std::uint32_t seed);

/// Returns the numbers 0 .. count - 1 in a random order: Fisher-Yates from the front, each draw from the low bits of
/// mt19937 with rejection, so that it is unbiased and the same on every platform.
[[nodiscard]] std::vector<std::uint32_t> shuffled_order(std::size_t count, std::mt19937& generator);

/// Returns the numbers 0 .. count - 1 in a random order whose every prefix is spread evenly over the range: the van der
/// Corput sequence, Owen-scrambled by `seed`.
[[nodiscard]] std::vector<std::uint32_t> spread_order(std::size_t count, std::uint32_t seed);

/// Returns the samples reordered: sample order[i] of `samples` at index i.
[[nodiscard]] Samples reordered(SampleView samples, std::span<const std::uint32_t> order);

/// Returns the first `count` samples, or all if there are fewer.
[[nodiscard]] Samples first(SampleView samples, std::size_t count);

/// Samples an index in proportion to its weight in constant time (alias method, Vose 1991).
class AliasTable {
  public:
    /// Preconditions: `weights` >= 0, not all zero. Uses float32 throughout.
    explicit AliasTable(std::span<const float> weights);

    /// Returns column floor(a * size) if b is at most its threshold, else its alias; a, b in [0, 1).
    [[nodiscard]] std::size_t sample(Point2 p) const;
    /// Returns an index for a number u in [0, 1), and the remainder: uniform in [0, 1) again, with fewer digits.
    struct Choice {
        std::size_t index = 0;
        double rest = 0;
    };
    [[nodiscard]] Choice sample(double u) const;
    /// Returns a number that maps to index i with remainder `rest`. Precondition: the index has its own column.
    [[nodiscard]] double inverse(const Choice& choice) const;
    /// Returns column `i` if u <= its threshold, else its alias.
    [[nodiscard]] std::size_t choose(std::size_t i, double u) const;
    /// Returns the probability of index i.
    [[nodiscard]] double probability(std::size_t i) const { return probability_[i]; }
    [[nodiscard]] std::size_t size() const { return columns_.size(); }

  private:
    /// Data of one draw, stored together.
    struct Column {
        float threshold = 1;
        std::uint32_t alias = 0;
    };
    std::vector<float> probability_;
    std::vector<Column> columns_;
};

}  // namespace lobelia
