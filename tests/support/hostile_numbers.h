// Every public function of a basis, an encoder, an evaluator and a storage, called with any numbers: the one list of
// calls behind the fuzzer fuzz_api and the test hostile_numbers_test. Nothing is asked of the results but that they
// come.
#pragma once

#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "lobelia/lobelia.h"

namespace lobelia::test {

/// Numbers that arithmetic stumbles over.
inline constexpr std::array k_hostile_numbers = {
    std::numeric_limits<float>::quiet_NaN(),   1.0f,  std::numeric_limits<float>::infinity(),      0.0f,
    -std::numeric_limits<float>::infinity(),   -1.0f, std::numeric_limits<float>::max(),           0.5f,
    std::numeric_limits<float>::lowest(),      -0.0f, std::numeric_limits<float>::denorm_min(),    1e20f,
    -std::numeric_limits<float>::denorm_min(), 0.3f,  std::numeric_limits<float>::signaling_NaN(), -1e-20f};

/// Draws numbers from a list, again and again.
class Numbers {
  public:
    explicit Numbers(std::span<const float> values, std::size_t first = 0) : values_(values), next_(first) {}
    float operator()() { return values_.empty() ? 0.0f : values_[next_++ % values_.size()]; }
    [[nodiscard]] Vec3 vector() { return draw<Vec3>(); }
    [[nodiscard]] Rgb colour() { return draw<Rgb>(); }
    [[nodiscard]] std::vector<Rgb> colours(std::size_t count) {
        std::vector<Rgb> result(count);
        for (Rgb& c : result) c = colour();
        return result;
    }
    template <std::size_t N>
    [[nodiscard]] Planes<N> planes(std::size_t count) {
        Planes<N> result(count);
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t k = 0; k < N; ++k) result.channel(k)[i] = (*this)();
        return result;
    }
    [[nodiscard]] Samples samples(std::size_t count) { return Samples(planes<7>(count)); }

  private:
    template <class Triple>
    Triple draw() {
        const float a = (*this)(), b = (*this)(), c = (*this)();
        return {a, b, c};
    }
    std::span<const float> values_;
    std::size_t next_;
};

/// Whole vectors and a rest, for each width.
inline constexpr std::size_t k_hostile_count = 19;

inline void call_basis(const Basis& basis, Numbers& numbers) {
    const auto c = numbers.colours(basis.size());
    const Directions directions = numbers.planes<3>(k_hostile_count);
    Colours out(k_hostile_count);
    basis.radiance(c, directions, out);
    static_cast<void>(basis.radiance_at(c, numbers.vector()));
    const Planes<1> planes = numbers.planes<1>(3 * basis.size() * k_hostile_count);
    std::vector<const float*> pointers;
    for (std::size_t p = 0; p < 3 * basis.size(); ++p) pointers.push_back(planes.channel(0) + p * k_hostile_count);
    radiance(basis, pointers, directions, out);
    const Rotation r = {numbers.vector(), numbers.vector(), numbers.vector()};
    const Basis::Rotated turned = basis.rotated(basis.domain() == Domain::sphere ? r : Rotation{Vec3{1, 0, 0}}, c);
    turned.basis->radiance(turned.c, directions, out);
    if (const FittedBasis* fitted = basis.fitted()) {
        std::vector<Rgb> found(basis.size());
        fitted->fit(numbers.colours(fitted->accumulated()->size()), found);
    }
}

inline void call_evaluator(const Evaluator& evaluator, std::size_t coefficients, Numbers& numbers) {
    const auto c = numbers.colours(coefficients);
    const Directions normals = numbers.planes<3>(k_hostile_count);
    Colours out(k_hostile_count);
    irradiance(evaluator, c, normals, out);
    static_cast<void>(irradiance(evaluator, c, numbers.vector()));
    const Planes<1> planes = numbers.planes<1>(3 * coefficients * k_hostile_count);
    std::vector<const float*> pointers;
    for (std::size_t p = 0; p < 3 * coefficients; ++p) pointers.push_back(planes.channel(0) + p * k_hostile_count);
    irradiance(evaluator, pointers, normals, out);
}

inline void call_specular(const SpecularEvaluator& evaluator, std::size_t coefficients, Numbers& numbers) {
    const auto c = numbers.colours(coefficients);
    const Directions normals = numbers.planes<3>(k_hostile_count), views = numbers.planes<3>(k_hostile_count);
    const Planes<1> alphas = numbers.planes<1>(k_hostile_count);
    Colours out(k_hostile_count);
    specular(evaluator, c, {normals, views, {alphas.channel(0), k_hostile_count}}, numbers.colour(), out);
}

inline void call_encoder(const std::shared_ptr<const Encoder>& encoder, Numbers& numbers) {
    Accumulator some(encoder), others(encoder);
    some.add(numbers.samples(k_hostile_count));
    some.add_sources(numbers.samples(3));
    others.add(numbers.samples(1));
    some.merge(others);
    static_cast<void>(some.solve());
    static_cast<void>(others.solve());
    static_cast<void>(Accumulator(encoder).solve());
    // A state of any numbers, as a file may have it.
    std::vector<float> state(encoder->state_size());
    for (float& f : state) f = numbers();
    std::vector<Rgb> c(encoder->basis().size());
    encoder->solve(state, c);
}

/// Packs two rows of three texels, reads them back whole and between texels.
inline void call_storage(const Storage& storage, const CoefficientTraits& traits, Numbers& numbers) {
    constexpr std::size_t width = 3, height = 2;
    const TextureLayout layout = storage.layout(traits);
    std::vector<std::vector<float>> planes(3 * traits.count, std::vector<float>(width * height));
    for (auto& plane : planes)
        for (float& f : plane) f = numbers();
    auto back = planes;
    const CoefficientPlanes in(width, height, std::span(planes), traits.count);
    const MutableCoefficientPlanes out(width, height, std::span(back), traits.count);
    const auto textures = pack(layout, in);
    unpack(layout, textures, out);
    allowed_error(storage, traits, in, out);
    std::vector<Rgb> c(traits.count);
    const auto sampler = TextureSampler::make(layout, textures);
    for (int i = 0; i < 3; ++i) {
        const float u = numbers(), v = numbers();
        sampler.value().sample({u, v}, c);
    }
}

/// What has neither basis nor codec: environments, maps of directions, tables, conventions, errors.
inline void call_samples(Numbers& numbers) {
    Image image(4, 2);
    for (Rgb& pixel : image.pixels) pixel = numbers.colour();
    const Directions directions = numbers.planes<3>(k_hostile_count);
    Colours out(k_hostile_count), opposite(k_hostile_count);
    for (const Domain domain : {Domain::sphere, Domain::hemisphere}) {
        const Samples seen = directed_samples(image, directions, domain);
        irradiance_sum(seen, directions, out);
        irradiance_sums(shuffled_texel_samples(image, domain, 1), directions, out, opposite);
    }
    static_cast<void>(mean_radiance(image));
    static_cast<void>(resize(image, {3, 5}));
    const float a = numbers(), b = numbers();
    for (const Vec3 d : {UniformSphere::sample({a, b}), UniformHemisphere::sample({a, b}),
                         CosineHemisphere::sample({a, b}), numbers.vector()}) {
        static_cast<void>(UniformSphere::inverse(d));
        static_cast<void>(UniformHemisphere::inverse(d));
        static_cast<void>(CosineHemisphere::inverse(d));
        static_cast<void>(lat_long(image).index(d));
    }
    const std::array weights = {numbers(), numbers(), numbers()};
    const AliasTable table(weights);
    static_cast<void>(table.sample(Point2{numbers(), numbers()}));
    static_cast<void>(table.sample(double{numbers()}));
    for (const ShConvention& convention : sh_conventions()) {
        const auto nine = numbers.colours(9);
        static_cast<void>(imported(convention, exported(convention, nine)));
    }
    const Planes<1> shares = numbers.planes<1>(k_hostile_count);
    static_cast<void>(errors(out, opposite, {shares.channel(0), k_hostile_count}));
    const SkyOptions options{numbers(), numbers(), numbers(), numbers()};
    if (check(options)) static_cast<void>(sky({2, 2}, options));
    static_cast<void>(Sky({})(numbers.vector()));
}

}  // namespace lobelia::test
