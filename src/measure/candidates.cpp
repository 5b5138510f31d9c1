// Measures candidates, then chooses among them.
#include "measure/candidates.h"

#include <algorithm>
#include <map>

#include "measure/comparison.h"
#include "measure/specular_errors.h"
#include "measure/study/study_bake.h"

namespace lobelia {
namespace {

std::vector<const Storage*> all_storages() {
    std::vector<const Storage*> all;
    for (const Storage& storage : storages()) all.push_back(&storage);
    return all;
}

/// Those whose error depends on a texel's own coefficients alone.
std::vector<const Storage*> storages_of_single_texels() {
    std::vector<const Storage*> single = all_storages();
    std::erase_if(single, [](const Storage* storage) { return shares_texels(*storage); });
    return single;
}

double error_of(const Method& method, Need need) {
    return need == Need::radiance ? method.radiance.rms : method.irradiance_over_pi.rms;
}

/// Returns the codec of the best encoder for each basis and evaluator: the others take as many bytes.
std::vector<CodecName> best_codecs(const Comparison& comparison, Domain domain, Need need) {
    std::map<std::pair<std::string, std::string>, const Method*> best;
    for (const Method& m : comparison.methods) {
        if (m.domain != domain) continue;
        const Method*& known = best[{m.name.basis, m.name.evaluator}];
        if (known == nullptr || error_of(m, need) < error_of(*known, need)) known = &m;
    }
    std::vector<CodecName> names;
    for (const auto& [key, method] : best) names.push_back(method->name);
    return names;
}

std::vector<Candidate> specular_candidates(const Image& environment) {
    SpecularErrorOptions measuring;
    measuring.storages = storages_of_single_texels();
    std::vector<Candidate> candidates;
    for (const SpecularError& e : specular_errors(environment, measuring))
        candidates.push_back({{e.basis, e.encoder, e.evaluator}, e.storage, e.bytes, e.error, e.nanoseconds});
    return candidates;
}

Result<std::vector<Candidate>> candidates_of(const Image& environment, Domain domain, Need need,
                                             const Progress& progress) {
    // Find the best encoders first, then store their coefficients.
    ComparisonOptions comparing;
    comparing.pictures = comparing.convergence = false;
    const auto first = compare(environment, all_codecs(), comparing, progress);
    if (!first) return first.error();
    comparing.storages = storages_of_single_texels();
    const auto comparison = compare(environment, best_codecs(*first, domain, need), comparing, progress);
    if (!comparison) return comparison.error();

    const double mean = mean_value(*comparison);
    std::vector<Candidate> candidates;
    for (const Method& m : comparison->methods)
        for (const StorageErrors& s : m.storage)
            // Values beyond the storage's limits: the error of this environment says nothing about the next.
            if (s.cut == 0)
                candidates.push_back({m.name, s.storage, s.bytes,
                                      (need == Need::radiance ? s.radiance_rms : s.irradiance_over_pi_rms) / mean,
                                      need == Need::irradiance ? m.evaluate_ns_per_normal : 0});
    return candidates;
}

/// The choice; the only error left is that nothing fits the budget.
Result<Advice> chosen(std::vector<Candidate> candidates, const AdviceOptions& options) {
    auto advice = advise(std::move(candidates), options);
    if (!advice) return Error{"--budget: " + advice.error().message};
    return advice;
}

}  // namespace

Result<Advice> advise(const Image& environment, Domain domain, const AdviceOptions& options, const Progress& progress) {
    if (options.need == Need::specular) {
        if (domain == Domain::hemisphere)
            return Error{"--need specular is measured over the whole sphere; leave --domain hemisphere out"};
        return chosen(specular_candidates(environment), options);
    }
    auto candidates = candidates_of(environment, domain, options.need, progress);
    if (!candidates) return candidates.error();
    return chosen(*std::move(candidates), options);
}

Result<Advice> advise(const Scene& scene, std::size_t texels, const AdviceOptions& options, const Progress& progress) {
    if (options.need != Need::irradiance) return Error{"--need: lightmaps can be measured by irradiance only"};
    BakeOptions bake;
    bake.codec.clear();
    BakeStudyOptions studying;
    studying.texels = texels;
    studying.reference_samples = 4096;
    studying.storages = all_storages();
    const std::atomic<bool> never = false;
    const auto measured = measure_baked_codecs(scene, bake, studying, never, progress);
    if (!measured) return measured.error();
    std::vector<Candidate> candidates;
    for (const BakedCodec& c : measured->codecs)
        if (c.storage != nullptr) candidates.push_back({c.name, std::string(c.storage->name), c.bytes, c.tilted, 0});
    return chosen(std::move(candidates), options);
}

}  // namespace lobelia
