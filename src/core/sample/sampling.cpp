// Point sequences in the unit square, their maps onto the sphere and the hemisphere, shuffling, discrete sampling.
#include "lobelia/sampling.h"

#include <bit>
#include <numeric>

#include "core/sample/scramble.h"

namespace lobelia {
namespace {

constexpr std::array<std::string_view, k_sequences.size()> k_sequence_names = {"random", "stratified", "hammersley",
                                                                               "halton", "r2",         "sobol"};

double unit_interval(std::uint_fast32_t v) { return static_cast<double>(v) * 0x1p-32; }

double radical_inverse(std::uint64_t i, std::uint32_t base) {
    double value = 0;
    for (double digit = 1.0 / base; i > 0; i /= base, digit /= base) value += digit * static_cast<double>(i % base);
    return value;
}

std::vector<Point2> stratified_points(std::size_t count, std::mt19937& generator) {
    const auto columns = static_cast<std::size_t>(std::max(1.0, std::round(std::sqrt(static_cast<double>(count)))));
    const std::size_t rows = (count + columns - 1) / columns;
    const auto order = shuffled_order(rows * columns, generator);
    std::vector<Point2> points(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double a = unit_interval(generator()), b = unit_interval(generator());
        points[i] = {(static_cast<double>(order[i] / columns) + a) / static_cast<double>(rows),
                     (static_cast<double>(order[i] % columns) + b) / static_cast<double>(columns)};
    }
    return points;
}

/// Direction at height z and azimuth 2 pi b about the z axis.
Vec3 spiral_direction(double z, double b) {
    const double r = std::sqrt(std::max(0.0, 1 - z * z)), phi = 2 * k_pi * b;
    return {static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)), static_cast<float>(z)};
}

double azimuth(Vec3 direction) {
    const double turn = std::atan2(static_cast<double>(direction.y), static_cast<double>(direction.x)) / (2 * k_pi);
    return turn < 0 ? turn + 1 : turn;
}

}  // namespace

std::string_view sequence_name(Sequence sequence) { return k_sequence_names[static_cast<std::size_t>(sequence)]; }

std::optional<Sequence> sequence_from_name(std::string_view name) {
    for (Sequence sequence : k_sequences)
        if (sequence_name(sequence) == name) return sequence;
    return std::nullopt;
}

double radical_inverse_2(std::uint32_t i) { return unit_interval(reverse_bits(i)); }

std::vector<Point2> sequence_points(Sequence sequence, std::size_t count, std::uint32_t seed) {
    std::mt19937 generator(seed);
    if (sequence == Sequence::stratified) return stratified_points(count, generator);

    std::vector<Point2> points(count);
    // The plastic number g solves g^3 = g + 1; steps 1 / g and 1 / g^2 are the least regular pair (Roberts).
    constexpr double plastic = 1.32471795724474602596;
    const Point2 start = {0.5 + unit_interval(mix(seed, 0)), 0.5 + unit_interval(mix(seed, 1))};
    const auto fraction = [](double v) { return v - std::floor(v); };
    for (std::size_t i = 0; i < count; ++i) {
        const auto n = static_cast<std::uint32_t>(i);
        switch (sequence) {
            case Sequence::random: {
                const double a = unit_interval(generator());
                points[i] = {a, unit_interval(generator())};
                break;
            }
            case Sequence::hammersley:
                points[i] = {static_cast<double>(i) / static_cast<double>(count), radical_inverse_2(n)};
                break;
            case Sequence::halton:
                points[i] = {radical_inverse(i + 1, 2), radical_inverse(i + 1, 3)};
                break;
            case Sequence::r2:
                points[i] = {fraction(start.a + static_cast<double>(i) / plastic),
                             fraction(start.b + static_cast<double>(i) / (plastic * plastic))};
                break;
            case Sequence::sobol: {
                const auto [a, b] = scrambled_sobol(n, mix(seed, 0), seed);
                points[i] = {unit_interval(a), unit_interval(b)};
                break;
            }
            case Sequence::stratified:
                break;
        }
    }
    return points;
}

Vec3 UniformSphere::sample(Point2 p) { return spiral_direction(1 - 2 * p.a, p.b); }
double UniformSphere::pdf(Vec3) { return 1 / (4 * k_pi); }
Point2 UniformSphere::inverse(Vec3 direction) { return {(1.0 - direction.z) / 2, azimuth(direction)}; }

Vec3 UniformHemisphere::sample(Point2 p) { return spiral_direction(1 - p.a, p.b); }
double UniformHemisphere::pdf(Vec3 direction) { return direction.z >= 0 ? 1 / (2 * k_pi) : 0; }
Point2 UniformHemisphere::inverse(Vec3 direction) { return {1.0 - direction.z, azimuth(direction)}; }

Vec3 CosineHemisphere::sample(Point2 p) { return spiral_direction(std::sqrt(1 - p.a), p.b); }
double CosineHemisphere::pdf(Vec3 direction) { return std::max(0.0f, direction.z) / k_pi; }
Point2 CosineHemisphere::inverse(Vec3 direction) {
    return {1.0 - static_cast<double>(direction.z) * direction.z, azimuth(direction)};
}

Directions uniform_directions(Domain domain, Sequence sequence, std::size_t count, std::uint32_t seed) {
    Directions directions(count);
    const auto points = sequence_points(sequence, count, seed);
    for (std::size_t i = 0; i < count; ++i)
        set_entry(directions.view(), i,
                  domain == Domain::sphere ? UniformSphere::sample(points[i]) : UniformHemisphere::sample(points[i]));
    return directions;
}

std::vector<std::uint32_t> shuffled_order(std::size_t count, std::mt19937& generator) {
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    for (std::size_t first = 0; first + 1 < count; ++first) {
        // Draw uniformly from [0, last] by masking to just enough bits and rejecting what lies above.
        const auto last = static_cast<std::uint32_t>(count - 1 - first);
        const std::uint32_t mask = (1u << std::bit_width(last)) - 1u;
        std::uint32_t draw = 0;
        do draw = static_cast<std::uint32_t>(generator()) & mask;
        while (draw > last);
        std::swap(order[first], order[first + draw]);
    }
    return order;
}

std::vector<std::uint32_t> spread_order(std::size_t count, std::uint32_t seed) {
    // Run through the next power of two and leave out what lies beyond the range.
    const int bits = static_cast<int>(std::bit_width(count > 0 ? count - 1 : 0));
    std::vector<std::uint32_t> order;
    order.reserve(count);
    for (std::uint64_t i = 0; i < std::uint64_t{1} << bits; ++i) {
        const std::uint32_t scrambled = reverse_bits(scramble_mirrored(static_cast<std::uint32_t>(i), mix(seed, 0)));
        const std::uint32_t position = bits == 0 ? 0 : scrambled >> (32 - bits);
        if (position < count) order.push_back(position);
    }
    return order;
}

Samples reordered(SampleView samples, std::span<const std::uint32_t> order) {
    check_equal("places of the order", order.size(), samples.size);
    for (const std::uint32_t i : order) check_range("index of a sample", i, 0, samples.size - 1);
    Planes<7> result(samples.size);
    for (std::size_t k = 0; k < 7; ++k) {
        const float* from = samples.channel(k);
        float* to = result.channel(k);
        for (std::size_t i = 0; i < order.size(); ++i) to[i] = from[order[i]];
    }
    return Samples(std::move(result));
}

Samples first(SampleView samples, std::size_t count) {
    const std::size_t kept = std::min(count, samples.size);
    Planes<7> result(kept);
    for (std::size_t k = 0; k < 7; ++k) std::copy_n(samples.channel(k), kept, result.channel(k));
    return Samples(std::move(result));
}

AliasTable::AliasTable(std::span<const float> weights) : probability_(weights.size()), columns_(weights.size()) {
    check_range("weights", weights.size(), 1, UINT32_MAX);
    // Normalise, then scale so that the mean is 1.
    float sum = 0;
    for (float w : weights) sum += w;
    std::vector<float> scaled(weights.size());
    for (std::size_t i = 0; i < weights.size(); ++i) {
        probability_[i] = weights[i] / sum;
        scaled[i] = probability_[i] * static_cast<float>(weights.size());
    }

    // Sort the columns into those below and those above the mean.
    std::vector<std::uint32_t> small, large;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        columns_[i].alias = static_cast<std::uint32_t>(i);
        (scaled[i] < 1 ? small : large).push_back(static_cast<std::uint32_t>(i));
    }

    // Fill each small column up with a part of a large one.
    while (!small.empty() && !large.empty()) {
        const std::uint32_t s = small.back(), l = large.back();
        small.pop_back();
        large.pop_back();
        columns_[s] = {scaled[s], l};
        scaled[l] = (scaled[l] + scaled[s]) - 1;
        (scaled[l] < 1 ? small : large).push_back(l);
    }
}

std::size_t AliasTable::sample(Point2 p) const {
    // A NaN becomes 0.
    const double last = static_cast<double>(size() - 1);
    return choose(static_cast<std::size_t>(std::min(std::max(0.0, p.a * static_cast<double>(size())), last)), p.b);
}

AliasTable::Choice AliasTable::sample(double u) const {
    // A NaN becomes 0.
    const double scaled = std::max(0.0, u * static_cast<double>(size()));
    const auto i = static_cast<std::size_t>(std::min(scaled, static_cast<double>(size() - 1)));
    const double within = scaled - static_cast<double>(i), threshold = columns_[i].threshold;
    const auto below_one = [](double v) { return std::clamp(v, 0.0, 1 - 0x1p-53); };
    if (within < threshold) return {i, below_one(within / threshold)};
    return {columns_[i].alias, below_one((within - threshold) / (1 - threshold))};
}

double AliasTable::inverse(const Choice& choice) const {
    return (static_cast<double>(choice.index) + choice.rest * columns_[choice.index].threshold) /
           static_cast<double>(size());
}

std::size_t AliasTable::choose(std::size_t i, double u) const {
    return u <= columns_[i].threshold ? i : columns_[i].alias;
}

}  // namespace lobelia
