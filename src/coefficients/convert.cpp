// Reads one form, mirrors, writes another.
#include "coefficients/convert.h"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "coefficients/coefficient_file.h"
#include "coefficients/convention_file.h"
#include "core/math/harmonics.h"
#include "io/json.h"

namespace lobelia {
namespace {

/// Returns the codec of a written file of `count` harmonics: the requested one, or the first of the list.
Result<CodecName> codec_for(const std::string& name, std::size_t count) {
    const auto matches = [&](const Basis& basis) {
        const auto degree = basis.harmonics_degree();
        return degree && harmonics::coefficient_count(*degree) == count;
    };
    if (!name.empty()) {
        const auto codec = make_codec(name);
        if (!codec) return codec.error();
        if (!matches(codec->basis()))
            return Error{fmt::format("codec \"{}\" does not have {} spherical harmonics", name, count)};
        return codec->name();
    }
    for (const CodecName& codec : all_codecs())
        if (matches(**make_basis(codec.basis))) return codec;
    return Error{fmt::format("no listed codec has {} spherical harmonics", count)};
}

/// Lobelia's coefficients from a file of either form.
Result<std::vector<Rgb>> read(std::string_view text, const std::string& name, const ShConvention* from) {
    if (from != nullptr) {
        const auto theirs = convention_from_text(*from, text, name);
        if (!theirs) return theirs.error();
        return imported(*from, *theirs);
    }
    auto file = coefficients_from_text(text, name);
    if (!file) return file.error();
    const auto codec = make_codec(file->codec.str());
    if (!codec) return codec.error();
    if (!codec->basis().harmonics_degree())
        return Error{name + ": " + file->codec.basis + " has no spherical harmonics; encode with another codec"};
    return std::move(file->c);
}

Status check_finite(std::span<const Rgb> c, const std::string& name) {
    for (const Rgb& v : c)
        if (!std::isfinite(v.r) || !std::isfinite(v.g) || !std::isfinite(v.b))
            return Error{name + ": a converted coefficient is beyond float32"};
    return Done{};
}

/// Null for the empty name.
Result<const ShConvention*> convention_named(const std::string& name) {
    if (name.empty()) return nullptr;
    return find_sh_convention(name);
}

}  // namespace

Result<Converted> convert(std::string_view text, const std::string& name, const ConvertOptions& options) {
    if (options.from.empty() && options.to.empty())
        return Error{"give --from, --to or both: one end of the conversion is not a coefficient file"};
    const auto from = convention_named(options.from), to = convention_named(options.to);
    if (!from) return from.error();
    if (!to) return to.error();
    auto input = read(text, name, *from);
    if (!input) return input.error();
    std::vector<Rgb> c = *std::move(input);
    if (options.mirrored) c = mirrored(c, static_cast<std::size_t>(*options.mirrored));
    if (auto status = check_finite(c, name); !status) return status.error();

    if (*to == nullptr) {
        const auto codec = codec_for(options.codec, c.size());
        if (!codec) return codec.error();
        return Converted{to_text(CoefficientFile{*codec, std::move(c)}), {}};
    }
    const ShConvention& convention = **to;
    Converted result;
    if (c.size() > harmonics::coefficient_count(convention.degree))
        result.warnings.push_back(
            fmt::format("{}: {} has no degrees above {}; they are left out", name, convention.name, convention.degree));
    const auto theirs = exported(convention, c);
    if (auto status = check_finite(theirs, name); !status) return status.error();
    result.text = json_text(to_json(convention, theirs), 1) + "\n";
    return result;
}

}  // namespace lobelia
