// THE lists: bases, encoders, and through the bases their evaluators. Every codec follows from them.
#include <algorithm>
#include <array>
#include <numeric>

#include "core/basis/ahd.h"
#include "core/basis/ambient_cube_irradiance.h"
#include "core/basis/ambient_dice.h"
#include "core/basis/cosine_lobes.h"
#include "core/basis/directional_lightmaps.h"
#include "core/basis/hemisphere_polynomials.h"
#include "core/basis/octahedral.h"
#include "core/basis/sg/fitted_gaussians.h"
#include "core/basis/sg/spherical_gaussians.h"
#include "core/basis/sh/spherical_harmonics.h"
#include "core/basis/sh/zh3.h"
#include "core/encode/moments.h"
#include "core/encode/sequential.h"
#include "lobelia/codec.h"
#include "lobelia/specular.h"

namespace lobelia {
namespace {

using BasisPtr = std::shared_ptr<const Basis>;
using LinearPtr = std::shared_ptr<const LinearBasis>;
using EncoderPtr = std::shared_ptr<const Encoder>;

/// The listed bases. A family (below) makes each from its name, and may know more names than are listed.
constexpr std::array k_bases = {
    "sg12",      "sg12h",        "sh1",        "sh2", "sh3",     "sh4",          "sh5",
    "sh6",       "sh7",          "sh8",        "zh3", "zh3-rgb", "ambient-cube", "ambient-cube-e",
    "dice-srbf", "dice-bezier",  "dice-ycocg", "ahd", "sgfit3",  "sgfit4",       "sgfit6",
    "oct8",      "oct16",        "hl2",        "h4",  "h6",      "sh1h",         "irradz",
    "enlighten", "enlighten-rgb"};

constexpr std::array k_families = {
    &SphericalGaussians::from_name,    &SphericalHarmonics::from_name,    &Zh3::from_name,
    &CosineLobes::from_name,           &AmbientCubeIrradiance::from_name, &AmbientDice::from_name,
    &AmbientHighlight::from_name,      &FittedGaussians::from_name,       &OctahedralTexels::from_name,
    &HemispherePolynomials::from_name, &DirectionalLightmap::from_name};

constexpr std::array k_patterns = {
    NamePattern{"sg<N>, sg<N>a", "N spherical Gaussians on the sphere, 1 to 512; a: and an ambient lobe"},
    NamePattern{"sg<N>h", "N on the hemisphere"},
    NamePattern{"sg<N>@S", "any of these with sharpness S, 0.01 to 10000, instead of their own"},
    NamePattern{"sgfit<N>", "N spherical Gaussians with fitted axes and sharpness, 1 to 12"},
    NamePattern{"oct<N>", "N x N octahedral texels, N even, 2 to 64"},
    NamePattern{"sg:FILE, sgh:FILE", "lobes from a file, a line \"x y z sharpness\" or \"ambient\" each"},
};

enum class Needs { any_basis, non_negative_basis };
enum class Listed { yes, no };

struct EncoderEntry {
    const char* name;
    Needs needs;
    const char* limit;  ///< the encoder whose solution this one strives for
    EncoderPtr (*make)(LinearPtr);
    Listed listed = Listed::yes;  ///< variants for study are known by name but not part of the product
};

template <MomentSolver solver>
EncoderPtr moments(LinearPtr basis) {
    return make_moment_encoder(std::move(basis), solver);
}
template <Sign sign>
EncoderPtr progressive(LinearPtr basis) {
    return make_progressive(std::move(basis), sign);
}
template <ProgressiveOptions::Denominator denominator>
EncoderPtr progressive_with(LinearPtr basis) {
    return make_progressive(std::move(basis), Sign::any, {.denominator = denominator});
}
EncoderPtr progressive_ramped(LinearPtr basis) { return make_progressive(std::move(basis), Sign::any, {.ramp = 64}); }
EncoderPtr progressive_accelerated(LinearPtr basis) {
    return make_progressive(std::move(basis), Sign::any, {.acceleration = 3});
}
template <Sign sign>
EncoderPtr running_average(LinearPtr basis) {
    return make_running_average(std::move(basis), sign);
}

constexpr std::array k_encoders = {
    EncoderEntry{"projection", Needs::any_basis, "least-squares", moments<MomentSolver::projection>},
    EncoderEntry{"running-average", Needs::non_negative_basis, "least-squares", running_average<Sign::any>},
    EncoderEntry{"running-average-nn", Needs::non_negative_basis, "nnls", running_average<Sign::non_negative>},
    EncoderEntry{"progressive", Needs::any_basis, "least-squares", progressive<Sign::any>},
    EncoderEntry{"progressive-nn", Needs::non_negative_basis, "nnls", progressive<Sign::non_negative>},
    EncoderEntry{"moments", Needs::any_basis, "least-squares", moments<MomentSolver::analytic_gram>},
    EncoderEntry{"least-squares", Needs::any_basis, "least-squares", moments<MomentSolver::sampled_gram>},
    EncoderEntry{"regularised", Needs::any_basis, "least-squares", moments<MomentSolver::regularised>},
    EncoderEntry{"matrix-gain", Needs::any_basis, "least-squares", make_matrix_gain},
    EncoderEntry{"nnls", Needs::non_negative_basis, "nnls", moments<MomentSolver::non_negative>},
    EncoderEntry{"joint", Needs::any_basis, "joint", moments<MomentSolver::joint>},
    EncoderEntry{"joint-nn", Needs::non_negative_basis, "joint-nn", moments<MomentSolver::joint_non_negative>},
    EncoderEntry{"progressive-sampled", Needs::any_basis, "least-squares",
                 progressive_with<ProgressiveOptions::Denominator::sampled>, Listed::no},
    EncoderEntry{"progressive-exact", Needs::any_basis, "least-squares",
                 progressive_with<ProgressiveOptions::Denominator::exact>, Listed::no},
    EncoderEntry{"progressive-ramped", Needs::any_basis, "least-squares", progressive_ramped, Listed::no},
    EncoderEntry{"progressive-accelerated", Needs::any_basis, "least-squares", progressive_accelerated, Listed::no},
};

bool suits(const EncoderEntry& entry, const LinearBasis& accumulated) {
    return entry.needs == Needs::any_basis || accumulated.is_non_negative();
}
bool suits(const EncoderEntry& entry, const Basis& basis) {
    return suits(entry, basis.linear() ? *basis.linear() : *basis.fitted()->accumulated());
}

std::vector<std::string> names_where(const auto& wanted) {
    std::vector<std::string> names;
    for (const auto& entry : k_encoders)
        if (wanted(entry)) names.emplace_back(entry.name);
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

std::string quoted(std::string_view name) { return "\"" + std::string(name) + "\""; }

}  // namespace

std::vector<std::string> basis_names() { return {k_bases.begin(), k_bases.end()}; }

std::vector<std::string> encoder_names() {
    return names_where([](const EncoderEntry& entry) { return entry.listed == Listed::yes; });
}

std::vector<std::string> encoder_variant_names() {
    return names_where([](const EncoderEntry& entry) { return entry.listed == Listed::no; });
}

std::vector<std::string> encoder_names(const Basis& basis) {
    const auto listed = basis.listed_encoders();
    return names_where([&](const EncoderEntry& entry) {
        const bool wanted = listed.empty() || std::find(listed.begin(), listed.end(), entry.name) != listed.end();
        return entry.listed == Listed::yes && wanted && suits(entry, basis);
    });
}

std::vector<NamePattern> basis_name_patterns() { return {k_patterns.begin(), k_patterns.end()}; }

std::string encoder_limit(std::string_view encoder) {
    for (const auto& entry : k_encoders)
        if (entry.name == encoder) return entry.limit;
    return std::string(encoder);
}

std::string default_codec() { return "sh2/moments/convolution"; }

std::vector<CodecName> all_codecs() {
    std::vector<CodecName> codecs;
    for (const char* name : k_bases) {
        const BasisPtr basis = make_basis(name).value();
        for (const auto& encoder : encoder_names(*basis))
            for (const auto& evaluator : basis->evaluator_names()) codecs.push_back({name, encoder, evaluator});
    }
    return codecs;
}

Result<BasisPtr> make_basis(std::string_view name) {
    for (const auto& from_name : k_families) {
        auto basis = from_name(name);
        if (!basis || *basis) return basis;
    }
    return Error{"unknown basis " + quoted(name) + nearest_names(name, basis_names())};
}

Result<EncoderPtr> make_encoder(std::string_view name, BasisPtr basis) {
    for (const auto& entry : k_encoders) {
        if (entry.name != name) continue;
        if (!suits(entry, *basis))
            return Error{"encoder " + quoted(name) + " needs a basis of non-negative functions, which " +
                         basis->name() + " is not"};
        if (basis->linear()) return entry.make(as_linear(basis));
        const std::shared_ptr<const FittedBasis> fitted(basis, basis->fitted());
        return make_fitted_encoder(fitted, entry.make(fitted->accumulated()));
    }
    return Error{"unknown encoder " + quoted(name) + nearest_names(name, encoder_names())};
}

Result<std::shared_ptr<const Evaluator>> make_evaluator(std::string_view name, const Basis& basis) {
    if (auto evaluator = basis.evaluator(name)) return evaluator;
    return Error{"unknown evaluator " + quoted(name) + " for basis " + basis.name() +
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
    return Error{"unknown reading of gloss " + quoted(name) + " for basis " + basis->name() +
                 nearest_names(name, specular_names(*basis))};
}

Result<CodecName> parse_codec_name(std::string_view name) {
    // The basis may hold slashes itself (a file's path): split at the last two.
    const auto last = name.rfind('/');
    const auto none = std::string_view::npos;
    const auto first = last == none || last == 0 ? none : name.rfind('/', last - 1);
    if (first == none) {
        std::vector<std::string> known;
        for (const auto& codec : all_codecs()) known.push_back(codec.str());
        return Error{"codec " + quoted(name) + " is not of the form basis/encoder/evaluator" +
                     nearest_names(name, known)};
    }
    return CodecName{std::string(name.substr(0, first)), std::string(name.substr(first + 1, last - first - 1)),
                     std::string(name.substr(last + 1))};
}

Result<Codec> make_codec(std::string_view name) {
    auto parts = parse_codec_name(name);
    if (!parts) return parts.error();
    const auto in_codec = [&](const Error& error) { return Error{"codec " + quoted(name) + ": " + error.message}; };
    auto basis = make_basis(parts->basis);
    if (!basis) return in_codec(basis.error());
    auto encoder = make_encoder(parts->encoder, *basis);
    if (!encoder) return in_codec(encoder.error());
    auto evaluator = make_evaluator(parts->evaluator, **basis);
    if (!evaluator) return in_codec(evaluator.error());
    return Codec(*parts, *encoder, *evaluator);
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
    // Nothing is near: where the list is short, say all of it.
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
    if (evaluator_->negative() == Negative::clamped) clamp_negative(out);
}

void Codec::irradiance(std::span<const Rgb> c, DirectionView normals, MutableColourView out) const {
    lobelia::irradiance(*evaluator_, c, normals, out);
}

}  // namespace lobelia
