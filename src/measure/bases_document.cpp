// Writes docs/bases.md: a table, and a section for each family.
#include "measure/bases_document.h"

#include <algorithm>
#include <iomanip>
#include <sstream>
#include <vector>

#include "lobelia/codec.h"
#include "lobelia/specular.h"
#include "lobelia/storage.h"
#include "measure/comparison.h"

namespace lobelia {
namespace {

using BasisPtr = std::shared_ptr<const Basis>;

constexpr const char* k_head =
    R"(# Bases

Written by `lobelia list --markdown` from the descriptions in the code; a test keeps it current. Conventions of axes,
harmonics and lobes are in [conventions.md](conventions.md), encoders in [encoders.md](encoders.md), evaluators of lobes
in [evaluators.md](evaluators.md), specular evaluators in [specular.md](specular.md); [adding-a-basis.md](adding-a-basis.md)
explains how to add one. `lobelia compare` measures them on an environment of yours.

A **linear** basis is a sum of functions. A **fitted** one is found from the coefficients of a linear basis that is
accumulated for it, and evaluated in its own way. A coefficient is three floats: a colour, or a vector where the table says so.
Bytes are those of float32.

The pictures are of ennis.hdr (`docs/make-pictures`), each basis with the encoder `least-squares`, or `moments` where it
is not listed with that; bases over the hemisphere see directions above z = 0 only.

)";

constexpr const char* k_patterns_head = R"(
Other members of these families, by name:

)";

/// A paragraph, broken before column 120.
std::string wrapped(const std::string& text) {
    std::string result;
    std::size_t column = 0;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        if (column > 0 && column + 1 + word.size() > 120) {
            result += '\n';
            column = 0;
        } else if (column > 0) {
            result += ' ';
            ++column;
        }
        result += word;
        column += word.size();
    }
    return result + "\n";
}

std::string joined(const std::vector<std::string>& names) {
    std::string text;
    for (const auto& name : names) text += (text.empty() ? "`" : ", `") + name + "`";
    return text;
}

std::string kind_of(const Basis& basis) {
    return basis.linear() ? "linear" : "fitted from `" + basis.fitted()->accumulated()->name() + "`";
}

std::string overview(const std::vector<BasisPtr>& bases) {
    std::string text = "| basis | description | domain | kind | floats | bytes |\n|---|---|---|---|---:|---:|\n";
    for (const BasisPtr& basis : bases) {
        const std::size_t floats = 3 * basis->size();
        text += "| `" + basis->name() + "` | " + basis->description() + " | " +
                std::string(domain_name(basis->domain())) + " | " + kind_of(*basis) + " | " + std::to_string(floats) +
                " | " + std::to_string(4 * floats) + " |\n";
    }
    return text;
}

/// "`sh1` to `sh8`" for all of the members that share a section.
std::string members(const std::vector<BasisPtr>& family) {
    std::vector<std::string> names;
    for (const BasisPtr& basis : family) names.push_back(basis->name());
    return joined(names);
}

std::string vectors_among(const Basis& basis) {
    const auto meanings = basis.meanings();
    const auto shapes = std::count(meanings.begin(), meanings.end(), Meaning::shape);
    if (shapes == 0) return "";
    return " " + std::to_string(shapes) +
           (shapes == 1 ? " coefficient is a direction" : " coefficients are directions") +
           " or another shape parameter, not light.";
}

/// Ranges of the coefficients, as far as the traits state them, and the storages that hold them.
std::string ranges(const BasisPtr& basis) {
    const CoefficientTraits traits = coefficient_traits(basis);
    std::ostringstream text;
    if (!traits.lead_bounds.empty()) {
        text << "**Ranges** of `" << basis->name()
             << "`, for light that is nowhere negative, degree by degree: at most ";
        const auto& bounds = traits.lead_bounds;
        for (std::size_t i = 0; i < bounds.size(); ++i)
            if (i == 0 || bounds[i] != bounds[i - 1]) text << (i == 0 ? "" : ", ") << std::setprecision(3) << bounds[i];
        text << " times the first, channel by channel. ";
    } else if (traits.non_negative) {
        text << "**Ranges** at least 0 from a non-negative encoder, of both signs from the others. ";
    } else if (basis->linear()) {
        text << "**Ranges** of both signs, without a bound. ";
    }
    std::vector<std::string> names;
    for (const Storage& storage : storages())
        if (suits(storage, traits)) names.emplace_back(storage.name);
    text << "[Stored](storage.md) as " << joined(names) << ".";
    return text.str();
}

std::string evaluators(const std::vector<BasisPtr>& family) {
    std::string text = "| evaluator | range | error | below 0 |\n|---|---|---|---|\n";
    std::vector<std::string> seen;
    for (const BasisPtr& basis : family)
        for (const auto& name : basis->evaluator_names()) {
            if (std::find(seen.begin(), seen.end(), name) != seen.end()) continue;
            seen.push_back(name);
            const auto evaluator = basis->evaluator(name);
            const Accuracy accuracy = evaluator->accuracy();
            text += "| `" + name + "` | " + accuracy.range + " | " + accuracy.error + " | " +
                    (evaluator->negative() == Negative::clamped ? "replaced by 0" : "kept") + " |\n";
        }
    return text;
}

/// A table of the pictures that docs/make-pictures makes.
std::string pictures(const std::vector<BasisPtr>& family) {
    std::string head = "| | reference |", rule = "|---|---|", radiance = "| radiance |", irradiance = "| irradiance |";
    const auto add = [&](const std::string& name) {
        const std::string file = "(images/bases/" + name + "-";
        radiance += " ![" + name + "]" + file + "radiance.png) |";
        irradiance += " ![" + name + "]" + file + "irradiance.png) |";
    };
    add("reference");
    for (const BasisPtr& basis : family) {
        head += " `" + basis->name() + "` |";
        rule += "---|";
        add(basis->name());
    }
    return head + "\n" + rule + "\n" + radiance + "\n" + irradiance + "\n\n";
}

/// The family's own specular evaluators; empty if it has none.
std::string specular(const std::vector<BasisPtr>& family) {
    const Basis& first = *family.front();
    const auto names = first.specular_names();
    if (names.empty()) return "";
    std::string text = "\n| specular | range | error |\n|---|---|---|\n";
    for (const auto& name : names) {
        const Accuracy accuracy = first.specular(name)->accuracy();
        text += "| `" + name + "` | " + accuracy.range + " | " + accuracy.error + " |\n";
    }
    return text;
}

std::string section(const std::vector<BasisPtr>& family) {
    const Basis& first = *family.front();
    const BasisCard& card = card_of(first);
    std::string text = "\n## " + std::string(card.family) + "\n\n" + wrapped(members(family) + ".");
    text += "\n```\n" + wrapped(std::string(card.formula)) + "```\n\n" + pictures(family);
    text += wrapped("**Good at** " + std::string(card.good_at) + ".") + "\n";
    text += wrapped("**Bad at** " + std::string(card.bad_at) + ".") + "\n";
    text += wrapped(ranges(family.back())) + "\n";
    const bool all = first.linear() && card.encoders.empty();
    text += wrapped("Listed with " +
                    (all ? std::string("every compatible encoder") : "the encoders " + joined(encoder_names(first))) +
                    "." + vectors_among(first)) +
            "\n";
    return text + evaluators(family) + specular(family);
}

}  // namespace

std::string bases_markdown() {
    std::vector<BasisPtr> bases;
    for (const auto& name : basis_names()) bases.push_back(make_basis(name).value());
    std::string text = k_head + overview(bases) + k_patterns_head;
    for (const auto& [pattern, meaning] : basis_name_patterns())
        text += "- `" + std::string(pattern) + "`: " + std::string(meaning) + "\n";

    // Families in the order of their first members.
    std::vector<std::vector<BasisPtr>> families;
    for (const BasisPtr& basis : bases) {
        const auto found = std::find_if(families.begin(), families.end(), [&](const auto& family) {
            return card_of(*family.front()).family == card_of(*basis).family;
        });
        if (found == families.end())
            families.push_back({basis});
        else
            found->push_back(basis);
    }
    for (const auto& family : families) text += section(family);
    return text;
}

}  // namespace lobelia
