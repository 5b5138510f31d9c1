// Wrong use of the library: arrays of another size, accumulators of another encoder, empty grids. Every public function
// refuses them in release builds, too, and says both values.
#include "lobelia/contract.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "lobelia/lobelia.h"

namespace lobelia {
namespace {

struct Violated : std::invalid_argument {
    using std::invalid_argument::invalid_argument;
};

/// Throws at violations during its lifetime.
class ThrowAtViolations {
  public:
    ThrowAtViolations() : before_(set_contract_handler([](const ContractViolation& v) { throw Violated(v.str()); })) {}
    ~ThrowAtViolations() { set_contract_handler(before_); }
    ThrowAtViolations(const ThrowAtViolations&) = delete;
    ThrowAtViolations& operator=(const ThrowAtViolations&) = delete;

  private:
    ContractHandler before_;
};

/// The message of the violation that `call` commits; empty if it commits none.
template <class Call>
std::string violation(const Call& call) {
    const ThrowAtViolations throwing;
    try {
        call();
    } catch (const Violated& violated) {
        return violated.what();
    }
    return {};
}

#define EXPECT_VIOLATES(text, ...)                                           \
    EXPECT_NE(violation([&] { __VA_ARGS__; }).find(text), std::string::npos) \
        << "is: " << violation([&] { __VA_ARGS__; })

/// Calls `call(basis)` with each listed basis.
template <class Call>
void for_each_basis(const Call& call) {
    for (const std::string& name : basis_names()) {
        SCOPED_TRACE(name);
        call(make_basis(name).value());
    }
}

/// Sizes beside the right one.
std::vector<std::size_t> wrong_sizes(std::size_t right) { return {0, right - 1, right + 1}; }

std::string both(std::size_t found, std::size_t required) {
    return ": " + std::to_string(found) + ", must be " + std::to_string(required);
}

const Directions k_two = [] {
    Directions two(2);
    set_entry(two.view(), 0, Vec3{0, 0, 1});
    set_entry(two.view(), 1, Vec3{0.6f, 0, 0.8f});
    return two;
}();

TEST(EveryBasis, RefusesAnotherNumberOfCoefficients) {
    for_each_basis([](const std::shared_ptr<const Basis>& basis) {
        Colours out(2), few(1);
        const Rotation same{Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        for (const std::size_t size : wrong_sizes(basis->size())) {
            const std::vector<Rgb> c(size);
            const std::string text = "coefficients" + both(size, basis->size());
            EXPECT_VIOLATES(text, basis->radiance(c, k_two, out));
            EXPECT_VIOLATES(text, static_cast<void>(basis->radiance_at(c, {0, 0, 1})));
            EXPECT_VIOLATES(text, static_cast<void>(basis->rotated(same, c)));
            const std::vector<const float*> planes(3 * size, out.channel(0));
            EXPECT_VIOLATES("must be", radiance(*basis, planes, k_two, out));
        }
        EXPECT_VIOLATES("colours", basis->radiance(std::vector<Rgb>(basis->size()), k_two, few));
        if (const FittedBasis* fitted = basis->fitted()) {
            const std::size_t from = fitted->accumulated()->size();
            std::vector<Rgb> c(basis->size()), short_of(basis->size() - 1);
            EXPECT_VIOLATES("accumulated coefficients" + both(from - 1, from),
                            fitted->fit(std::vector<Rgb>(from - 1), c));
            EXPECT_VIOLATES("coefficients" + both(basis->size() - 1, basis->size()),
                            fitted->fit(std::vector<Rgb>(from), short_of));
        }
    });
}

TEST(EveryEvaluator, RefusesAnotherNumberOfCoefficients) {
    for_each_basis([](const std::shared_ptr<const Basis>& basis) {
        Colours out(2), few(1);
        for (const std::string& name : basis->evaluator_names()) {
            SCOPED_TRACE(name);
            const auto evaluator = make_evaluator(name, *basis).value();
            for (const std::size_t size : wrong_sizes(basis->size())) {
                const std::vector<Rgb> c(size);
                const std::string text = "coefficients" + both(size, basis->size());
                EXPECT_VIOLATES(text, irradiance(*evaluator, c, k_two, out));
                EXPECT_VIOLATES(text, static_cast<void>(irradiance(*evaluator, c, Vec3{0, 0, 1})));
                const std::vector<const float*> planes(3 * size, out.channel(0));
                EXPECT_VIOLATES("must be", irradiance(*evaluator, planes, k_two, out));
            }
            EXPECT_VIOLATES("colours", irradiance(*evaluator, std::vector<Rgb>(basis->size()), k_two, few));
        }
    });
}

TEST(EverySpecularEvaluator, RefusesArraysOfAnotherSize) {
    for_each_basis([](const std::shared_ptr<const Basis>& basis) {
        Colours out(2), few(1);
        const std::vector<float> alphas = {0.2f, 0.3f};
        const SpecularPoints points{k_two, k_two, alphas};
        for (const std::string& name : specular_names(*basis)) {
            SCOPED_TRACE(name);
            const auto evaluator = make_specular(name, basis).value();
            const std::size_t size = basis->size();
            const std::vector<Rgb> c(size);
            EXPECT_VIOLATES("coefficients" + both(size - 1, size),
                            evaluator->reflected(std::span(c).first(size - 1), points, out));
            EXPECT_VIOLATES("colours", evaluator->reflected(c, points, few));
            EXPECT_VIOLATES("alphas", evaluator->reflected(c, {k_two, k_two, std::span(alphas).first(1)}, out));
            EXPECT_VIOLATES("views", evaluator->reflected(c, {k_two, DirectionView(k_two).part(0, 1), alphas}, out));
        }
    });
}

TEST(EveryEncoder, RefusesStatesOfAnotherSize) {
    for (const char* basis_name : {"sh2", "sg12", "zh3"}) {
        const std::shared_ptr<const Basis> basis = make_basis(basis_name).value();
        for (const std::string& name : encoder_names(*basis)) {
            SCOPED_TRACE(basis_name + ("/" + name));
            const auto encoder = make_encoder(name, basis).value();
            const std::size_t size = encoder->state_size();
            std::vector<float> right(size), wrong(size - 1);
            std::vector<Rgb> c(basis->size()), few(basis->size() - 1);
            const Samples samples(3);
            const std::string text = "floats of the state" + both(size - 1, size);
            EXPECT_VIOLATES(text, encoder->add(wrong, samples));
            EXPECT_VIOLATES(text, encoder->add_sources(wrong, samples));
            EXPECT_VIOLATES(text, encoder->merge(wrong, right));
            EXPECT_VIOLATES(text, encoder->merge(right, wrong));
            EXPECT_VIOLATES(text, encoder->solve(wrong, c));
            EXPECT_VIOLATES("coefficients" + both(few.size(), c.size()), encoder->solve(right, few));
        }
    }
}

TEST(Accumulators, MergeThoseOfEqualEncodersOnly) {
    const auto encoder = [](const char* name, const char* basis) {
        return make_encoder(name, make_basis(basis).value()).value();
    };
    Accumulator mine(encoder("moments", "sg12"));
    mine.merge(Accumulator(encoder("moments", "sg12")));
    EXPECT_VIOLATES("accumulator of another encoder", mine.merge(Accumulator(encoder("moments", "sh8"))));
    // As many floats, other functions; the same functions, other sums.
    EXPECT_VIOLATES("of sg12@3, must be", mine.merge(Accumulator(encoder("moments", "sg12@3"))));
    EXPECT_VIOLATES("accumulator of another encoder", mine.merge(Accumulator(encoder("least-squares", "sg12"))));
    Accumulator learned(encoder("running-average", "sg12"));
    EXPECT_VIOLATES("accumulator of another encoder", learned.merge(Accumulator(encoder("progressive", "sg12"))));

    // A rotated basis has the name of the first.
    const auto lobes = make_basis("sg12").value();
    const auto turned = lobes->rotated(rotation_about({0, 0, 1}, 0.3), std::vector<Rgb>(12)).basis;
    EXPECT_EQ(turned->name(), lobes->name());
    EXPECT_VIOLATES("accumulator of another encoder", mine.merge(Accumulator(make_encoder("moments", turned).value())));
}

TEST(Accumulators, AreAsTheyWereAfterARefusedMerge) {
    Accumulator mine(make_codec("sh1/moments/convolution")->encoder());
    Samples one(1);
    one.set(0, {{0, 0, 1}, {1, 2, 3}, 1});
    mine.add(one);
    const std::vector<float> before(mine.state().begin(), mine.state().end());
    EXPECT_VIOLATES("another encoder", mine.merge(Accumulator(make_codec("sh2/moments/convolution")->encoder())));
    EXPECT_TRUE(std::equal(before.begin(), before.end(), mine.state().begin()));
}

TEST(Environments, RefuseEmptyGrids) {
    EXPECT_VIOLATES("0 x 0, must be at least 1 x 1", static_cast<void>(sky({0, 0})));
    EXPECT_VIOLATES("0 x 1", static_cast<void>(resize(Image(2, 1), {0, 1})));
    EXPECT_VIOLATES("0 x 0", static_cast<void>(mean_radiance(Image())));
    EXPECT_VIOLATES("0 x 0", static_cast<void>(directed_samples(Image(), k_two, Domain::sphere)));
    EXPECT_VIOLATES("0 x 3", static_cast<void>(LatLong{0, 3}.direction(std::size_t{0})));
    Image cut(4, 2);
    cut.pixels.pop_back();
    EXPECT_VIOLATES("pixels", static_cast<void>(texel_samples(cut)));
    SkyOptions below;
    below.sun_elevation = -10;
    EXPECT_VIOLATES("elevation", static_cast<void>(sky({4, 2}, below)));
}

TEST(Constructors, RefuseWhatIsOutOfRange) {
    EXPECT_VIOLATES("degree: 0, must be 1 to 8", static_cast<void>(spherical_harmonics(0)));
    EXPECT_VIOLATES("lobes: 0, must be 1 to 512", static_cast<void>(spherical_gaussians(0)));
    EXPECT_VIOLATES("lobes: 0", static_cast<void>(spherical_gaussians(std::vector<Lobe>{})));
    EXPECT_VIOLATES("sharpness: nan", static_cast<void>(spherical_gaussians({{{0, 0, 1}, std::nanf("")}})));
    EXPECT_VIOLATES("lobes: 13, must be 1 to 12", static_cast<void>(fitted_gaussians(13)));
    EXPECT_VIOLATES("resolution", static_cast<void>(octahedral_texels(3)));
    EXPECT_VIOLATES("polynomials", static_cast<void>(hemisphere_polynomials(5)));
    EXPECT_VIOLATES("directions: 0", static_cast<void>(make_sampled_specular(spherical_harmonics(1), 0)));
    EXPECT_VIOLATES("weights: 0", static_cast<void>(AliasTable({})));
}

TEST(Storages, RefusePlanesOfAnotherShape) {
    const CoefficientTraits traits{4, true, true, {1, 2, 2, 2}};
    std::vector<std::vector<float>> planes(12, std::vector<float>(4));
    const CoefficientPlanes whole(2, 2, std::span(planes), 4), few(2, 2, std::span(planes), 3);
    for (const Storage& storage : storages()) {
        SCOPED_TRACE(storage.name);
        const TextureLayout layout = storage.layout(traits);
        EXPECT_VIOLATES("planes of coefficients: 9, must be 12", static_cast<void>(pack(layout, few)));
        const auto textures = pack(layout, whole);
        const MutableCoefficientPlanes other(3, 2, std::span(planes), 4);
        EXPECT_VIOLATES("width of the texture", unpack(layout, textures, other));
        std::vector<Rgb> c(3);
        EXPECT_VIOLATES("coefficients: 3, must be 4", TextureSampler::make(layout, textures)->sample({0, 0}, c));
    }
}

TEST(Measures, RefuseArraysOfAnotherSize) {
    const Colours a(3), b(2);
    const std::vector<float> weights(3);
    EXPECT_VIOLATES("colours for the reference: 3, must be 2", static_cast<void>(errors(a, b, weights)));
    EXPECT_VIOLATES("weights: 2, must be 3", static_cast<void>(errors(a, a, std::span(weights).first(2))));
    EXPECT_VIOLATES("index of a sample: 5", static_cast<void>(reordered(Samples(2), std::vector<std::uint32_t>{0, 5})));
}

TEST(Results, ThatFailedHaveNoValue) {
    EXPECT_VIOLATES("value() of a failure: unknown basis", static_cast<void>(make_basis("nothing").value()));
    EXPECT_VIOLATES("error() of a success", static_cast<void>(make_basis("sh1").error()));
}

TEST(ContractDeathTest, TheDefaultHandlerPrintsBothValuesAndAborts) {
    const auto codec = make_codec("sh2/moments/convolution").value();
    EXPECT_DEATH(static_cast<void>(codec.irradiance(std::vector<Rgb>(8), Vec3{0, 0, 1})),
                 "lobelia: harmonics.cpp:[0-9]+: sum_at: coefficients: 8, must be 9");
}

TEST(ContractDeathTest, AHandlerThatReturnsIsFollowedByAbort) {
    EXPECT_DEATH(
        {
            set_contract_handler(
                [](const ContractViolation& v) { std::fprintf(stderr, "own: %s\n", v.message.c_str()); });
            static_cast<void>(sky({0, 0}));
        },
        "own: grid of texels: 0 x 0");
}

}  // namespace
}  // namespace lobelia
