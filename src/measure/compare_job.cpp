// Resolves names, then compares.
#include "measure/compare_job.h"

#include <algorithm>

namespace lobelia {
namespace {

template <class T>
bool contains(const std::vector<T>& list, const T& value) {
    return std::find(list.begin(), list.end(), value) != list.end();
}

template <class T>
void add_once(std::vector<T>& list, const T& value) {
    if (!contains(list, value)) list.push_back(value);
}

/// An empty filter passes everything.
bool passes(const std::vector<std::string>& filter, const std::string& name) {
    return filter.empty() || contains(filter, name);
}

Status check_names(const char* kind, const std::vector<std::string>& names, const std::vector<std::string>& known) {
    for (const auto& name : names)
        if (!contains(known, name))
            return Error{std::string("unknown ") + kind + " \"" + name + "\"" + nearest_names(name, known)};
    return Done{};
}

Result<std::vector<CodecName>> codecs_by_name(const std::vector<std::string>& names) {
    std::vector<CodecName> chosen;
    for (const auto& name : names) {
        const auto codec = make_codec(name);
        if (!codec) return codec.error();
        add_once(chosen, codec->name());
    }
    return chosen;
}

/// The listed encoders of a basis, and those for study that the filter names.
std::vector<std::string> encoders_of(const std::shared_ptr<const Basis>& basis, const CodecFilter& filter) {
    auto encoders = encoder_names(*basis);
    for (const auto& name : encoder_variant_names())
        if (contains(filter.encoders, name) && make_encoder(name, basis)) encoders.push_back(name);
    return encoders;
}

/// The named storages, each once; "all" is the whole list.
Result<std::vector<const Storage*>> chosen_storages(const std::vector<std::string>& names) {
    std::vector<const Storage*> chosen;
    for (const auto& name : names) {
        if (name == "all") {
            for (const Storage& storage : storages()) add_once(chosen, &storage);
            continue;
        }
        const auto storage = find_storage(name);
        if (!storage) return storage.error();
        add_once(chosen, *storage);
    }
    return chosen;
}

/// A named storage must be compatible with at least one of the codecs.
Status check_used(const std::vector<std::string>& names, const Comparison& comparison) {
    for (const auto& name : names) {
        const bool is_used = std::any_of(comparison.methods.begin(), comparison.methods.end(), [&](const Method& m) {
            return std::any_of(m.storage.begin(), m.storage.end(),
                               [&](const StorageErrors& s) { return s.storage == name; });
        });
        if (name != "all" && !is_used)
            return Error{"--storage " + name +
                         ": compatible with none of these codecs; lobelia list --storages CODEC prints those that are"};
    }
    return Done{};
}

}  // namespace

Result<std::vector<CodecName>> chosen_codecs(const CodecFilter& filter) {
    if (!filter.codecs.empty()) return codecs_by_name(filter.codecs);
    auto known_encoders = encoder_names();
    for (const auto& name : encoder_variant_names()) known_encoders.push_back(name);
    if (auto status = check_names("encoder", filter.encoders, known_encoders); !status) return status.error();

    std::vector<std::string> bases, known_evaluators;
    for (const auto& name : filter.bases.empty() ? basis_names() : filter.bases) add_once(bases, name);
    std::vector<CodecName> chosen;
    for (const auto& basis_name : bases) {
        const auto basis = make_basis(basis_name);
        if (!basis) return basis.error();
        const auto evaluators = (*basis)->evaluator_names();
        for (const auto& name : evaluators) add_once(known_evaluators, name);
        for (const auto& encoder : encoders_of(*basis, filter))
            for (const auto& evaluator : evaluators)
                if (passes(filter.encoders, encoder) && passes(filter.evaluators, evaluator))
                    chosen.push_back({basis_name, encoder, evaluator});
    }
    std::sort(known_evaluators.begin(), known_evaluators.end());
    if (auto status = check_names("evaluator", filter.evaluators, known_evaluators); !status) return status.error();
    if (chosen.empty()) return Error{"no codec matches: none of the given encoders works with the given bases"};
    return chosen;
}

Status check(const CompareJob& job) {
    if (!job.recipe)
        if (const auto codecs = chosen_codecs(job.codecs); !codecs) return codecs.error();
    if (const auto storages = chosen_storages(job.storages); !storages) return storages.error();
    return Done{};
}

Result<Comparison> compare(const Image& environment, const CompareJob& job, const Progress& progress) {
    if (job.recipe) return run_recipe(*job.recipe, environment, job.options, progress);
    const auto codecs = chosen_codecs(job.codecs);
    if (!codecs) return codecs.error();
    auto storages = chosen_storages(job.storages);
    if (!storages) return storages.error();
    ComparisonOptions options = job.options;
    options.storages = *std::move(storages);
    auto result = compare(environment, *codecs, options, progress);
    if (!result) return result;
    if (auto status = check_used(job.storages, *result); !status) return status.error();
    return result;
}

}  // namespace lobelia
