// Tests GGX reflection: samples against the pdf, rays against quadrature, the lobe table, sampled evaluation of any
// basis.
#include "core/math/ggx.h"

#include "core/sample/ggx_fast.h"
#include "lobelia/codec.h"
#include "lobelia/specular.h"
#include "support.h"

namespace lobelia {
namespace {

const ggx::View k_glossy_views[] = {ggx::make_view(1, 0.3f), ggx::make_view(0.7f, 0.5f), ggx::make_view(0.3f, 0.8f),
                                    ggx::make_view(0.15f, 0.4f)};

/// A smooth light >= 0.
double smooth_glossy_light(Vec3 w) { return 1.5 + static_cast<double>(w.x) - 0.4 * static_cast<double>(w.y * w.z); }

/// Integral over the upper hemisphere of f, by 96 x 192 directions.
template <class F>
double over_upper_hemisphere(const F& f) {
    static const SphereRule rule = product_rule(Domain::hemisphere, 96);
    double sum = 0;
    for (std::size_t i = 0; i < rule.weights.size(); ++i) sum += rule.weights[i] * f(direction_at(rule.directions, i));
    return sum;
}

TEST(VisibleNormal, RoundTrip) {
    for (const auto& view : k_glossy_views)
        for (const Point2 p : sequence_points(Sequence::sobol, 500, 3)) {
            const Point2 back = ggx::VisibleNormal::inverse(view, ggx::VisibleNormal::sample(view, p));
            EXPECT_NEAR(back.a, p.a, 2e-5);
            EXPECT_NEAR(back.b, p.b, 2e-5);
        }
}

TEST(VisibleNormal, DensityIntegratesToOne) {
    for (const auto& view : k_glossy_views)
        EXPECT_NEAR(over_upper_hemisphere([&](Vec3 h) { return ggx::VisibleNormal::pdf(view, h); }), 1, 2e-3);
}

// 6 heights x 8 azimuths, 20000 draws; chi-square of 47 degrees of freedom is above 93.2 once in 10^4 times.
TEST(VisibleNormal, SamplesFollowTheDensity) {
    constexpr std::size_t heights = 6, azimuths = 8, draws = 20000, fine = 24;
    for (const auto& view : k_glossy_views) {
        const auto bin = [&](double z, double turns) {
            return std::min(heights - 1, static_cast<std::size_t>(z * z * heights)) * azimuths +
                   std::min(azimuths - 1, static_cast<std::size_t>(turns * azimuths));
        };
        std::vector<double> seen(heights * azimuths), expected(heights * azimuths);
        std::mt19937 generator(5);
        std::uniform_real_distribution<double> uniform;
        for (std::size_t i = 0; i < draws; ++i) {
            const Vec3 h = ggx::VisibleNormal::sample(view, {uniform(generator), uniform(generator)});
            const double turns = std::atan2(static_cast<double>(h.y), static_cast<double>(h.x)) / (2 * k_pi);
            seen[bin(h.z, turns - std::floor(turns))] += 1;
        }
        // The density over each bin by midpoints; bins are equal steps in z^2, so dz = d(z^2) / (2 z).
        constexpr std::size_t rows = heights * fine, columns = azimuths * fine;
        for (std::size_t i = 0; i < rows; ++i)
            for (std::size_t j = 0; j < columns; ++j) {
                const double z = std::sqrt((static_cast<double>(i) + 0.5) / rows);
                const double turns = (static_cast<double>(j) + 0.5) / columns, r = std::sqrt(1 - z * z);
                const Vec3 h{static_cast<float>(r * std::cos(2 * k_pi * turns)),
                             static_cast<float>(r * std::sin(2 * k_pi * turns)), static_cast<float>(z)};
                expected[bin(z, turns)] +=
                    draws * ggx::VisibleNormal::pdf(view, h) * 2 * k_pi / (2 * z * rows * columns);
            }
        double chi_square = 0;
        for (std::size_t i = 0; i < seen.size(); ++i)
            if (expected[i] > 5) chi_square += (seen[i] - expected[i]) * (seen[i] - expected[i]) / expected[i];
        EXPECT_LT(chi_square, 93.2) << view.alpha << " " << view.cosine;
    }
}

TEST(Ggx, ReflectionIsReciprocal) {
    for (const auto& view : k_glossy_views)
        for (float z : {0.2f, 0.5f, 0.9f}) {
            const Vec3 l = normalize(Vec3{-0.4f, 0.3f, z});
            auto other = ggx::make_view({0, 0, 1}, l, view.alpha);
            const double there = ggx::reflection(view, l) / static_cast<double>(l.z);
            const double back =
                ggx::reflection(other, other.to_local(view.direction())) / static_cast<double>(view.cosine);
            EXPECT_NEAR(there, back, 1e-4 * there);
        }
}

TEST(Ggx, RaysIntegrateWhatQuadratureDoes) {
    for (const auto& view : k_glossy_views) {
        double by_rays = 0;
        for (const auto& ray : ggx::rays(view, 4096))
            by_rays += static_cast<double>(ray.weight) * smooth_glossy_light(ray.direction);
        const double exact =
            over_upper_hemisphere([&](Vec3 l) { return ggx::reflection(view, l) * smooth_glossy_light(l); });
        EXPECT_NEAR(by_rays, exact, 2e-3 * exact) << view.alpha << " " << view.cosine;
    }
}

// Independent visible normals: the mean of 20000 is within 4 standard errors of the integral, or once in 16000 times.
TEST(Ggx, SampledLobeIsWithinItsStandardError) {
    const Vec3 axis = normalize(Vec3{-0.5f, 0.2f, 0.6f});
    const auto light = [&](Vec3 l) { return std::exp(16 * (static_cast<double>(dot(l, axis)) - 1)); };
    std::mt19937 generator(9);
    std::uniform_real_distribution<double> uniform;
    for (const auto& view : k_glossy_views) {
        double sum = 0, squares = 0;
        constexpr int draws = 20000;
        for (int i = 0; i < draws; ++i) {
            const Vec3 h = ggx::VisibleNormal::sample(view, {uniform(generator), uniform(generator)});
            const Vec3 v = view.direction(), l = h * (2 * dot(v, h)) - v;
            const double pdf = ggx::VisibleNormal::pdf(view, h) / (4 * static_cast<double>(dot(v, h)));
            const double value = l.z > 0 ? ggx::reflection(view, l) / pdf * light(l) : 0;
            sum += value;
            squares += value * value;
        }
        const double mean = sum / draws, error = std::sqrt((squares / draws - mean * mean) / draws);
        const double exact = over_upper_hemisphere([&](Vec3 l) { return ggx::reflection(view, l) * light(l); });
        EXPECT_NEAR(mean, exact, 4 * error + 1e-3 * exact) << view.alpha << " " << view.cosine;
    }
}

TEST(Ggx, WhiteFurnaceLosesOnlyWhatFacetsHide) {
    double before = 1.001;
    for (float alpha : {0.01f, 0.1f, 0.3f, 0.6f, 1.0f}) {
        const double albedo = ggx::lobe(ggx::make_view(0.7f, alpha)).albedo;
        EXPECT_LE(albedo, before);
        before = albedo;
    }
    EXPECT_NEAR(ggx::lobe(ggx::make_view(0.7f, 0.01f)).albedo, 1, 2e-3);
    // View along the normal at alpha 1: D is 1 / pi, and the integral is 1 - ln 2.
    EXPECT_NEAR(ggx::lobe(ggx::make_view(1, 1)).albedo, 1 - std::log(2.0), 1e-3);
    for (const auto& view : k_glossy_views)
        EXPECT_NEAR(ggx::lobe(view).albedo, over_upper_hemisphere([&](Vec3 l) { return ggx::reflection(view, l); }),
                    2e-3);
}

TEST(Ggx, TableIsWithinItsStatedErrors) {
    for (const Point2 p : sequence_points(Sequence::halton, 300, 0)) {
        const auto view = ggx::make_view(static_cast<float>(0.1 + 0.9 * p.a), static_cast<float>(0.1 + 0.9 * p.b));
        const auto read = ggx::lobe(view), exact = ggx::lobe_by_rays(view, 4096);
        EXPECT_NEAR(read.albedo, exact.albedo, 1.5e-3);
        EXPECT_NEAR(read.fresnel, exact.fresnel, 1e-3);
        EXPECT_LT(length(read.axis - exact.axis), 6e-3 * std::sqrt(static_cast<double>(exact.spread)));
        EXPECT_NEAR(read.spread, exact.spread, 0.01 * static_cast<double>(exact.spread));
        for (std::size_t l = 0; l <= ggx::k_zonal_degree; ++l) EXPECT_NEAR(read.zonal[l], exact.zonal[l], 4e-3);
    }
}

TEST(Ggx, TableIsWithinItsStatedErrorsAtTheEdges) {
    for (const Point2 p : sequence_points(Sequence::halton, 300, 0)) {
        const auto near = [](double t) { return static_cast<float>(0.005 + 0.995 * t * t * t); };
        const auto view = ggx::make_view(near(p.b), near(p.a));
        const auto read = ggx::lobe(view), exact = ggx::lobe_by_rays(view, 4096);
        EXPECT_NEAR(read.albedo, exact.albedo, 0.015);
        EXPECT_NEAR(read.fresnel, exact.fresnel, 0.02);
        EXPECT_LT(length(read.axis - exact.axis), 0.12 * std::sqrt(static_cast<double>(exact.spread)));
        EXPECT_NEAR(read.spread, exact.spread, 0.5 * static_cast<double>(exact.spread));
        for (std::size_t l = 0; l <= ggx::k_zonal_degree; ++l) EXPECT_NEAR(read.zonal[l], exact.zonal[l], 0.014);
    }
}

/// One point with its normal up.
struct OneGlossyPoint {
    Directions normals{1}, views{1};
    float alpha;
    OneGlossyPoint(Vec3 view, float a) : alpha(a) {
        set_entry(normals, 0, Vec3{0, 0, 1});
        set_entry(views, 0, view);
    }
    [[nodiscard]] SpecularPoints points() const { return {normals, views, {&alpha, 1}}; }
};

TEST(Specular, SplitSumIsExactForConstantLight) {
    const OneGlossyPoint point(normalize(Vec3{0.8f, 0.3f, 0.4f}), 0.35f);
    const std::vector<Rgb> one = {Rgb{1, 1, 1} * std::sqrt(4 * static_cast<float>(k_pi)), {}, {}, {}};
    const auto evaluator = make_specular("sh-convolution", make_basis("sh1").value()).value();
    Colours out(1);
    specular(*evaluator, one, point.points(), {1, 0.04f, 0}, out);
    const auto view = ggx::make_view({0, 0, 1}, direction_at(point.views, 0), point.alpha);
    const auto under = [&](double f0) {
        return over_upper_hemisphere([&](Vec3 l) {
            const double c = static_cast<double>(dot(normalize(l + view.direction()), l));
            return ggx::reflection(view, l) * (f0 + (1 - f0) * std::pow(1 - c, 5));
        });
    };
    EXPECT_NEAR(colour_at(out, 0).r, under(1), 3e-3);
    EXPECT_NEAR(colour_at(out, 0).g, under(0.04), 3e-3);
    EXPECT_NEAR(colour_at(out, 0).b, under(0), 3e-3);
}

TEST(Specular, SamplingReadsEveryBasis) {
    const Samples samples = test::samples_of(Domain::sphere, 4096, [](Vec3) { return Rgb{1, 2, 3}; });
    const Samples above = test::samples_of(Domain::hemisphere, 4096, [](Vec3) { return Rgb{1, 2, 3}; });
    for (const char* name : {"sg12", "sg12h", "sh2", "ahd", "oct8", "h4"}) {
        const auto basis = make_basis(name).value();
        Accumulator accumulator(make_encoder("least-squares", basis).value());
        accumulator.add(basis->domain() == Domain::sphere ? samples : above);
        const OneGlossyPoint point(normalize(Vec3{0.2f, -0.5f, 0.7f}), 0.25f);
        Colours out(1);
        make_specular("sampled", basis).value()->reflected(accumulator.solve(), point.points(), out);
        const double albedo = ggx::lobe(ggx::make_view({0, 0, 1}, direction_at(point.views, 0), 0.25f)).albedo;
        // Twelve lobes ripple by a tenth.
        EXPECT_NEAR(colour_at(out, 0).g, 2 * albedo, 0.2) << name;
    }
}

TEST(Specular, NamesAreKnown) {
    for (const auto& name : basis_names()) {
        const auto basis = make_basis(name).value();
        for (const auto& reading : specular_names(*basis)) {
            const auto evaluator = make_specular(reading, basis);
            ASSERT_TRUE(evaluator) << name << " " << reading;
            EXPECT_EQ((*evaluator)->name(), reading);
        }
        const auto unknown = make_specular("sample", basis);
        ASSERT_FALSE(unknown);
        EXPECT_NE(unknown.error().message.find("did you mean sampled"), std::string::npos) << unknown.error().message;
    }
}

TEST(Ggx, TheFastFormsEqualTheExactOnes) {
    const Directions normals = uniform_directions(Domain::hemisphere, Sequence::sobol, 200, 3);
    for (const float alpha : {0.01f, 0.1f, 0.5f, 1.0f})
        for (std::size_t i = 0; i < normals.size(); ++i) {
            const Vec3 h = direction_at(normals, i);
            if (h.z < 0.05f) continue;
            const double exact = ggx::distribution(alpha, h);
            EXPECT_NEAR(ggx::fast::distribution(alpha, h), exact, 2e-5 * exact) << alpha;
            const double smith = ggx::smith(alpha, h);
            EXPECT_NEAR(ggx::fast::lambda(alpha, h), smith, 1e-6 + 2e-6 * smith) << alpha;
        }
}

TEST(Ggx, TheFastVisibleNormalsEqualTheExactOnes) {
    for (const float alpha : {0.05f, 0.3f, 1.0f})
        for (const float cosine : {0.1f, 0.5f, 0.95f}) {
            const auto view = ggx::make_view(cosine, alpha);
            for (const Point2 p : sequence_points(Sequence::sobol, 64, 5)) {
                const Pair pair{static_cast<float>(p.a), static_cast<float>(p.b)};
                const Vec3 exact = ggx::VisibleNormal::sample(view, {pair.a, pair.b});
                const Vec3 fast = ggx::fast::visible_normal(alpha, view.direction(), pair);
                EXPECT_LT(length(fast - exact), 3e-4f) << alpha << " " << cosine;
            }
        }
}

}  // namespace
}  // namespace lobelia
