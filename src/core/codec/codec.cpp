// Codecs by name: looks names up in the lists, puts codecs together, suggests the nearest names.
#include "lobelia/codec.h"

#include <algorithm>
#include <numeric>

#include "core/codec/catalogue.h"
#include "lobelia/specular.h"

namespace lobelia {
namespace {

using BasisPtr = std::shared_ptr<const Basis>;
using EncoderPtr = std::shared_ptr<const Encoder>;

std::vector<std::string> words(std::string_view text) {
    std::vector<std::string> result;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find(' ', begin), text.size());
        result.emplace_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return result;
}

bool contains(const std::vector<std::string>& names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_compatible(const EncoderEntry& entry, const Basis& basis) {
    if (entry.needs == Needs::any_basis) return true;
    return basis.linear() ? basis.linear()->is_non_negative() : basis.fitted()->accumulated()->is_non_negative();
}

std::vector<std::string> names_where(const auto& is_included) {
    std::vector<std::string> names;
    for (const EncoderEntry& entry : encoder_entries())
        if (is_included(entry)) names.emplace_back(entry.name);
    return names;
}

/// Levenshtein's edit distance.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row.back();
}

/// A name in quotation marks. Long names hold lists of lobes: their beginning is enough for a message.
std::string in_quotes(std::string_view name) {
    constexpr std::size_t most = 60;
    return "\"" + std::string(name.substr(0, most)) + (name.size() > most ? "..." : "") + "\"";
}

Result<Codec> put_together(CodecName name, const BasisPtr& basis) {
    auto encoder = make_encoder(name.encoder, basis);
    if (!encoder) return encoder.error();
    auto evaluator = make_evaluator(name.evaluator, *basis);
    if (!evaluator) return evaluator.error();
    return Codec(std::move(name), *encoder, *evaluator);
}

/// Clamps if `negative` requires it. Returns colours that need no clamping unchanged: splitting and rebuilding a colour
/// costs as much as evaluating it.
Rgb cut(Rgb c, Negative negative) {
    const bool below = c.r < 0 || c.g < 0 || c.b < 0;
    if (below && negative == Negative::clamped) [[unlikely]]
        return clamp_negative(c);
    return c;
}

}  // namespace

std::vector<std::string> basis_names() {
    std::vector<std::string> names;
    for (const BasisEntry& entry : basis_entries())
        for (std::string& name : words(entry.names)) names.push_back(std::move(name));
    return names;
}

std::vector<NamePattern> basis_name_patterns() {
    std::vector<NamePattern> patterns;
    for (const BasisEntry& entry : basis_entries())
        patterns.insert(patterns.end(), entry.patterns.begin(), entry.patterns.end());
    return patterns;
}

const BasisCard& card_of(const Basis& basis) {
    static const BasisCard none;
    const std::string name = basis.name();
    for (const BasisEntry& entry : basis_entries())
        if (contains(words(entry.names), name)) return entry.card;
    for (const BasisEntry& entry : basis_entries())
        if (const auto made = entry.make(name); made && *made) return entry.card;
    return none;
}

std::vector<std::string> encoder_names() {
    return names_where([](const EncoderEntry& entry) { return entry.listed == Listed::yes; });
}

std::vector<std::string> encoder_variant_names() {
    return names_where([](const EncoderEntry& entry) { return entry.listed == Listed::no; });
}

std::vector<std::string> encoder_names(const Basis& basis) {
    auto listed = words(card_of(basis).encoders);
    // Fits cost time, and encoders differ little after one.
    if (listed.empty() && basis.fitted()) listed = {"moments", "least-squares"};
    return names_where([&](const EncoderEntry& entry) {
        return entry.listed == Listed::yes && (listed.empty() || contains(listed, entry.name)) &&
               is_compatible(entry, basis);
    });
}

std::string encoder_limit(std::string_view encoder) {
    for (const EncoderEntry& entry : encoder_entries())
        if (entry.name == encoder) return std::string(entry.limit);
    return std::string(encoder);
}

std::vector<CodecName> all_codecs() {
    std::vector<CodecName> codecs;
    for (const std::string& name : basis_names()) {
        const BasisPtr basis = make_basis(name).value();
        for (const auto& encoder : encoder_names(*basis))
            for (const auto& evaluator : basis->evaluator_names()) codecs.push_back({name, encoder, evaluator});
    }
    return codecs;
}

Result<BasisPtr> make_basis(std::string_view name) {
    for (const BasisEntry& entry : basis_entries()) {
        auto basis = entry.make(name);
        if (!basis || *basis) return basis;
    }
    return Error{"unknown basis " + in_quotes(name) + nearest_names(name, basis_names())};
}

Result<EncoderPtr> make_encoder(std::string_view name, BasisPtr basis) {
    for (const EncoderEntry& entry : encoder_entries()) {
        if (entry.name != name) continue;
        if (!is_compatible(entry, *basis))
            return Error{"encoder " + in_quotes(name) + " needs a basis of non-negative functions, which " +
                         basis->name() + " is not"};
        if (basis->linear()) return entry.make(as_linear(basis));
        const std::shared_ptr<const FittedBasis> fitted(basis, basis->fitted());
        return make_fitted_encoder(fitted, entry.make(fitted->accumulated()));
    }
    return Error{"unknown encoder " + in_quotes(name) + nearest_names(name, encoder_names())};
}

Result<std::shared_ptr<const Evaluator>> make_evaluator(std::string_view name, const Basis& basis) {
    if (auto evaluator = basis.evaluator(name)) return evaluator;
    return Error{"unknown evaluator " + in_quotes(name) + " for basis " + basis.name() +
                 nearest_names(name, basis.evaluator_names())};
}

std::vector<std::string> specular_names(const Basis& basis) {
    auto names = basis.specular_names();
    names.emplace_back("sampled");
    return names;
}

Result<std::shared_ptr<const SpecularEvaluator>> make_specular(std::string_view name, BasisPtr basis) {
    if (name == "sampled") return make_sampled_specular(std::move(basis));
    if (auto evaluator = basis->specular(name)) return evaluator;
    return Error{"unknown specular evaluator " + in_quotes(name) + " for basis " + basis->name() +
                 nearest_names(name, specular_names(*basis))};
}

Result<CodecName> parse_codec_name(std::string_view name) {
    // On the command line the basis may hold slashes itself (a file's path): split at the last two.
    const auto last = name.rfind('/');
    const auto none = std::string_view::npos;
    const auto first = last == none || last == 0 ? none : name.rfind('/', last - 1);
    if (first == none) {
        std::vector<std::string> known;
        for (const auto& codec : all_codecs()) known.push_back(codec.str());
        return Error{"codec " + in_quotes(name) + " is not of the form basis/encoder/evaluator" +
                     nearest_names(name, known)};
    }
    return CodecName{std::string(name.substr(0, first)), std::string(name.substr(first + 1, last - first - 1)),
                     std::string(name.substr(last + 1))};
}

Result<Codec> make_codec(std::string_view name) {
    auto parts = parse_codec_name(name);
    if (!parts) return parts.error();
    const auto basis = make_basis(parts->basis);
    auto codec = basis ? put_together(*std::move(parts), *basis) : basis.error();
    if (!codec) return Error{"codec " + in_quotes(name) + ": " + codec.error().message};
    return codec;
}

Result<Codec> make_codec(const BasisPtr& basis, std::string_view encoder, std::string_view evaluator) {
    return put_together({basis->name(), std::string(encoder), std::string(evaluator)}, basis);
}

std::string nearest_names(std::string_view name, std::span<const std::string> known) {
    std::vector<std::pair<std::size_t, std::string>> ranked;
    for (const auto& candidate : known) ranked.emplace_back(edit_distance(name, candidate), candidate);
    std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::string text;
    for (std::size_t i = 0; i < std::min<std::size_t>(3, ranked.size()); ++i)
        if (ranked[i].first <= std::max<std::size_t>(3, name.size() / 2))
            text += (text.empty() ? "" : ", ") + ranked[i].second;
    if (!text.empty()) return " (did you mean " + text + "?)";
    // Nothing is near: give all of a short list.
    constexpr std::size_t short_list = 20;
    if (known.empty() || known.size() > short_list) return "";
    for (const auto& candidate : known) text += (text.empty() ? "" : ", ") + candidate;
    return " (known: " + text + ")";
}

std::vector<Rgb> Codec::encode(SampleView samples) const {
    Accumulator accumulator(encoder_);
    accumulator.add(samples);
    return accumulator.solve();
}

void Codec::radiance(std::span<const Rgb> c, DirectionView directions, MutableColourView out) const {
    basis().radiance(c, directions, out);
    if (negative_ == Negative::clamped) clamp_negative(out);
}

Rgb Codec::radiance(std::span<const Rgb> c, Vec3 direction) const {
    return cut(basis().radiance_at(c, direction), negative_);
}

void Codec::irradiance(std::span<const Rgb> c, DirectionView normals, MutableColourView out) const {
    lobelia::irradiance(*evaluator_, c, normals, out);
}

Rgb Codec::irradiance(std::span<const Rgb> c, Vec3 normal) const {
    return cut(evaluator_->signed_irradiance_at(c, normal), negative_);
}

}  // namespace lobelia
