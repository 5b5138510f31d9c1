// Tests that the comparison's figures equal independently computed ones, do not depend on threads, and survive writing
// and reading.
#include "measure/comparison.h"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "ennis.h"
#include "measure/comparison_json.h"
#include "support.h"
#include "threads.h"

namespace lobelia {
namespace {

using nlohmann::json;

ComparisonOptions figures_only() {
    ComparisonOptions options;
    options.pictures = false;
    options.convergence = false;
    return options;
}

const Method& method(const Comparison& comparison, const std::string& name) {
    const auto found = std::find_if(comparison.methods.begin(), comparison.methods.end(),
                                    [&](const Method& m) { return m.name.str() == name; });
    if (found == comparison.methods.end()) throw std::runtime_error("no method " + name);
    return *found;
}

TEST(Comparison, HarmonicsOnEnnisEqualThePeers) {
    SKIP_WITHOUT_ENNIS();
    struct Peer {
        const char* basis;
        double radiance, irradiance;  ///< unweighted, irradiance against a reference with an RMS noise of 0.0085
    };
    const std::vector<Peer> peers = {
        {"sh1", 4.8501, 0.5050}, {"sh2", 4.4368, 0.0940}, {"sh3", 3.9822, 0.0940}, {"sh4", 3.5772, 0.0311}};
    std::vector<CodecName> names;
    for (const Peer& peer : peers) names.push_back({peer.basis, "projection", "convolution"});
    const Comparison result = compare(test::ennis(), names, figures_only()).value();
    for (const Peer& peer : peers) {
        const Method& m = method(result, std::string(peer.basis) + "/projection/convolution");
        EXPECT_NEAR(m.radiance.rms_unweighted, peer.radiance, 3e-4 * peer.radiance) << peer.basis;
        EXPECT_NEAR(m.irradiance_over_pi.rms_unweighted, peer.irradiance, 0.0085) << peer.basis;
    }
}

/// Returns the report without its timings.
json timeless(const Comparison& comparison) {
    json report = to_json(comparison, {"test", comparison.grid, {}, 0});
    for (json& m : report["methods"]) {
        m.erase("encode_ms");
        m.erase("evaluate_ns_per_normal");
    }
    return report;
}

TEST(Comparison, SameBitsAtAnyThreadCount) {
    ComparisonOptions options;
    options.convergence = false;
    std::vector<CodecName> few;
    for (const char* name :
         {"sg12/progressive/hill", "sg12/least-squares/hill", "sg12h/joint/exact", "sh2/moments/convolution"})
        few.push_back(parse_codec_name(name).value());
    const auto run = [&](std::size_t threads, const std::vector<CodecName>& names, bool convergence) {
        options.convergence = convergence;
        return test::with_threads(threads, [&] { return compare(test::small_sky(), names, options).value(); });
    };
    const auto expect_same = [](const Comparison& a, const Comparison& b) {
        EXPECT_EQ(timeless(a).dump(), timeless(b).dump());
        const auto same = [](const std::map<std::string, Colours>& x, const std::map<std::string, Colours>& y) {
            ASSERT_EQ(x.size(), y.size());
            for (const auto& [name, colours] : x) EXPECT_EQ(test::largest_difference(colours, y.at(name)), 0) << name;
        };
        same(a.pictures.radiance, b.pictures.radiance);
        same(a.pictures.irradiance_over_pi, b.pictures.irradiance_over_pi);
        for (const auto& [domain, reference] : a.pictures.references)
            EXPECT_EQ(test::largest_difference(reference.irradiance_over_pi,
                                               b.pictures.references.at(domain).irradiance_over_pi),
                      0);
    };
    expect_same(run(1, all_codecs(), false), run(2, all_codecs(), false));
    expect_same(run(1, few, true), run(2, few, true));
}

TEST(Comparison, SeedChangesOrderOnly) {
    auto options = figures_only();
    const std::vector<CodecName> names = {{"sg12", "least-squares", "exact"}, {"sg12", "progressive", "exact"}};
    const Comparison a = compare(test::small_sky(), names, options).value();
    options.sampling.seed = 2;
    const Comparison b = compare(test::small_sky(), names, options).value();
    EXPECT_LE(test::distance(a.methods[0].c, b.methods[0].c), 1e-4 * test::norm(a.methods[0].c));
    EXPECT_GE(test::distance(a.methods[1].c, b.methods[1].c), 1e-4 * test::norm(a.methods[1].c));
}

TEST(Comparison, ErrorsOfTheMethodsAreThoseOfTheirCoefficients) {
    // Computed again here, from the coefficients alone.
    const Image sky = test::small_sky();
    for (const char* name : {"sg12/nnls/exact", "sg12h/least-squares/exact", "sh2/projection/convolution"}) {
        const CodecName codec_name = parse_codec_name(name).value();
        const Comparison result = compare(sky, {codec_name}, figures_only()).value();
        const Codec codec = make_codec(name).value();
        const Domain domain = codec.basis().domain();
        const Samples measured = texel_samples(resize(sky, k_measuring_grid), domain);
        const SampleView view = measured;
        Colours L(measured.size()), E(measured.size()), reference(measured.size());
        codec.radiance(result.methods[0].c, view.directions(), L);
        codec.irradiance(result.methods[0].c, view.directions(), E);
        irradiance_sum(texel_samples(sky, domain), view.directions(), reference);
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t i = 0; i < measured.size(); ++i) {
                E.channel(k)[i] *= static_cast<float>(1 / k_pi);
                reference.channel(k)[i] *= static_cast<float>(1 / k_pi);
            }
        const std::span weights{view.solid_angles(), view.size};
        const Errors radiance = errors(L, view.radiance(), weights), irradiance = errors(E, reference, weights);
        const Method& found = result.methods[0];
        EXPECT_NEAR(found.radiance.rms, radiance.rms, 1e-5 * radiance.rms) << name;
        EXPECT_NEAR(found.radiance.rms_unweighted, radiance.rms_unweighted, 1e-5 * radiance.rms_unweighted) << name;
        EXPECT_NEAR(found.irradiance_over_pi.rms, irradiance.rms, 1e-4 * irradiance.rms) << name;
        EXPECT_NEAR(found.irradiance_over_pi.smape, irradiance.smape, 1e-4 * irradiance.smape) << name;
        EXPECT_NEAR(found.irradiance_over_pi.worst, irradiance.worst, 1e-4 * irradiance.worst) << name;
    }
}

TEST(Comparison, BlackEnvironmentGivesZeros) {
    const Comparison result = compare(Image(64, 32), all_codecs(), figures_only()).value();
    for (const Method& m : result.methods) {
        EXPECT_EQ(m.radiance.rms, 0) << m.name.str();
        EXPECT_EQ(m.irradiance_over_pi.rms, 0) << m.name.str();
        EXPECT_EQ(m.irradiance_over_pi.smape, 0) << m.name.str();
    }
    // Non-finite numbers would be written as null.
    const json report = timeless(result);
    for (const json& m : report["methods"])
        for (const auto& [key, value] : m.items()) EXPECT_FALSE(value.is_null()) << key;
}

TEST(Comparison, StripsAndSingleTexelsAreEnvironmentsToo) {
    for (const LatLong grid : {LatLong{1, 1}, LatLong{2, 1}, LatLong{1, 2}, LatLong{300, 1}, LatLong{200001, 1}}) {
        Image image(grid.width, grid.height);
        std::fill(image.pixels.begin(), image.pixels.end(), Rgb{1, 2, 3});
        const auto result =
            compare(image, {{"sh1", "least-squares", "convolution"}, {"sg12", "regularised", "hill"}}, figures_only());
        ASSERT_TRUE(result) << grid.width;
        for (const Method& m : result->methods) EXPECT_TRUE(test::all_finite(m.c)) << grid.width << m.name.str();
    }
}

TEST(Comparison, UnknownNamesAreErrors) {
    EXPECT_FALSE(compare(test::small_sky(), {{"sg12x", "moments", "hill"}}, figures_only()));
}

TEST(Comparison, ProgressRisesToOne) {
    std::vector<double> seen;
    auto options = figures_only();
    const auto result = compare(test::small_sky(), {{"sh1", "moments", "convolution"}}, options,
                                [&](double share) { seen.push_back(share); });
    ASSERT_TRUE(result);
    ASSERT_FALSE(seen.empty());
    EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
    EXPECT_NEAR(seen.back(), 1, 1e-9);
}

// ---- Storages ----

std::vector<const Storage*> all_storages() {
    std::vector<const Storage*> all;
    for (const Storage& storage : storages()) all.push_back(&storage);
    return all;
}

TEST(StoredCoefficients, KeepEveryStoragesBound) {
    // Coefficients of both signs and of one sign, for every basis; the evaluator makes no difference.
    std::vector<CodecName> codecs;
    for (const CodecName& name : all_codecs())
        if ((name.encoder == "moments" || name.encoder == "joint" || name.encoder == "nnls") &&
            name.evaluator == make_basis(name.basis).value()->evaluator_names().front())
            codecs.push_back(name);
    auto options = figures_only();
    options.storages = all_storages();
    const Comparison result = compare(test::small_sky(), codecs, options).value();
    std::map<std::string, std::size_t> count;
    for (const Method& m : result.methods) {
        SCOPED_TRACE(m.name.str());
        EXPECT_FALSE(m.storage.empty());
        for (const StorageErrors& s : m.storage) {
            ++count[s.storage];
            EXPECT_LE(s.bound_used, 1) << s.storage;
            EXPECT_LE(s.largest_error, s.bound * 1.0001 + 2e-6) << s.storage;
            EXPECT_EQ(s.cut, 0u) << s.storage;
            EXPECT_TRUE(std::isfinite(s.radiance_rms) && std::isfinite(s.irradiance_over_pi_rms)) << s.storage;
            EXPECT_GT(s.bytes, 0) << s.storage;
        }
        // Floats lose nothing; one vector of coefficients is summed in another order than many.
        EXPECT_EQ(m.storage.front().storage, storages().front().name);
        EXPECT_EQ(m.storage.front().radiance_rms, m.radiance.rms);
        EXPECT_NEAR(m.storage.front().irradiance_over_pi_rms, m.irradiance_over_pi.rms,
                    1e-6 * m.irradiance_over_pi.rms);
    }
    for (const Storage& storage : storages()) EXPECT_GT(count[std::string(storage.name)], 0u) << storage.name;
}

TEST(StoredCoefficients, ChangeNothingElse) {
    auto options = figures_only();
    const std::vector<CodecName> codecs = {{"sh1", "least-squares", "convolution"}, {"sg12", "nnls", "exact"}};
    json without = timeless(compare(test::small_sky(), codecs, options).value());
    options.storages = all_storages();
    json with = timeless(compare(test::small_sky(), codecs, options).value());
    for (json& m : with["methods"]) {
        ASSERT_TRUE(m["storage"].is_array());
        for (const json& s : m["storage"]) {
            EXPECT_TRUE(s["name"].is_string());
            for (const char* key :
                 {"bytes", "radiance_rms", "irradiance_over_pi_rms", "largest_error", "bound", "bound_used", "cut"})
                EXPECT_TRUE(s[key].is_number()) << key;
        }
        m.erase("storage");
    }
    EXPECT_EQ(with, without);
}

// ---- report.json ----

TEST(ReportJson, HasTheFieldsOfItsSchema) {
    auto options = figures_only();
    options.convergence = true;
    const Comparison comparison =
        compare(test::small_sky(), {{"sg12", "nnls", "odd-exact"}, {"sh2", "moments", "convolution"}}, options).value();
    const json report = to_json(comparison, {"a \"name\"\n", {128, 64}, {"a warning"}, 3});
    EXPECT_EQ(json::parse(report.dump()), report);
    EXPECT_EQ(report["environment"]["name"], "a \"name\"\n");
    EXPECT_EQ(report["environment"]["width"], 64);
    EXPECT_EQ(report["environment"]["source_width"], 128);
    EXPECT_EQ(report["environment"]["sanitized_texels"], 3);
    for (const char* key : {"samples", "sequence", "seed", "recipe", "reference"})
        EXPECT_TRUE(report["settings"].contains(key)) << key;
    ASSERT_EQ(report["methods"].size(), 2u);
    for (const json& m : report["methods"]) {
        for (const char* key : {"name", "basis", "encoder", "evaluator"}) EXPECT_TRUE(m[key].is_string()) << key;
        for (const char* key : {"floats", "radiance_rms", "radiance_rms_unweighted", "irradiance_over_pi_rms",
                                "irradiance_over_pi_rms_unweighted", "irradiance_smape", "negative_share", "encode_ms",
                                "evaluate_ns_per_normal"})
            EXPECT_TRUE(m[key].is_number()) << key;
        const std::size_t floats = m["floats"];
        EXPECT_EQ(3 * m["coefficients"].size(), floats);
        EXPECT_EQ(m["name"], m["basis"].get<std::string>() + "/" + m["encoder"].get<std::string>() + "/" +
                                 m["evaluator"].get<std::string>());
        EXPECT_GE(m["negative_share"], 0);
        EXPECT_LE(m["negative_share"], 1);
    }
    EXPECT_EQ(report["methods"][0]["negative_share"], 0);
    EXPECT_FALSE(report["convergence"].empty());
}

}  // namespace
}  // namespace lobelia
