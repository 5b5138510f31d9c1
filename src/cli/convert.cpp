// lobelia convert: coefficients of spherical harmonics from and to the conventions of others.
#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "cli/common.h"
#include "cli/lobe_files.h"
#include "cli/verbs.h"
#include "core/math/harmonics.h"
#include "report/convention_json.h"

namespace lobelia::cli {
namespace {

struct ConvertArguments {
    std::string input, out, from, to, codec, mirror;
};

/// The codec whose coefficients of this many harmonics are: the one named, or the first of the list.
Result<CodecName> codec_for(const std::string& name, std::size_t count) {
    const auto suits = [&](const Basis& basis) {
        const auto degree = basis.harmonics_degree();
        return degree && harmonics::coefficient_count(*degree) == count;
    };
    if (!name.empty()) {
        const auto codec = make_codec(name);
        if (!codec) return codec.error();
        if (!suits(codec->basis()))
            return Error{fmt::format("codec \"{}\" is not of {} spherical harmonics", name, count)};
        return codec->name();
    }
    for (const CodecName& codec : all_codecs())
        if (suits(**make_basis(codec.basis))) return codec;
    return Error{fmt::format("no listed codec is of {} spherical harmonics", count)};
}

/// Our coefficients from the input file.
Result<std::vector<Rgb>> read(const ConvertArguments& options) {
    const auto text = read_text(options.input);
    if (!text) return text.error();
    if (!options.from.empty()) {
        const auto convention = find_sh_convention(options.from);
        if (!convention) return convention.error();
        const auto theirs = convention_from_text(**convention, *text, options.input);
        if (!theirs) return theirs.error();
        return imported(**convention, *theirs);
    }
    auto file = coefficients_from_json(*text, options.input);
    if (!file) return file.error();
    const auto codec = make_codec(file->codec.str());
    if (!codec) return codec.error();
    if (!codec->basis().harmonics_degree())
        return Error{options.input + ": " + file->codec.basis +
                     " has no spherical harmonics; encode with another codec"};
    return std::move(file->c);
}

Status convert_verb(const ConvertArguments& options) {
    if (options.from.empty() && options.to.empty())
        return Error{"give --from, --to or both: one end of the conversion is not a coefficient file"};
    const ShConvention* to = nullptr;
    if (!options.to.empty()) {
        const auto found = find_sh_convention(options.to);
        if (!found) return found.error();
        to = *found;
    }
    auto input = read(options);
    if (!input) return input.error();
    std::vector<Rgb> c = *std::move(input);
    if (!options.mirror.empty()) c = mirrored(c, static_cast<std::size_t>(options.mirror[0] - 'x'));

    nlohmann::json result;
    if (to) {
        if (c.size() > harmonics::coefficient_count(to->degree))
            complain(fmt::format("lobelia: warning: {}: {} has no degrees above {}; they are left out", options.input,
                                 to->name, to->degree));
        result = to_json(*to, exported(*to, c));
    } else {
        const auto codec = codec_for(options.codec, c.size());
        if (!codec) return codec.error();
        result = to_json(CoefficientFile{*codec, c});
    }
    return write_file_atomically(options.out,
                                 result.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace

Verb add_convert(CLI::App& app) {
    auto options = std::make_shared<ConvertArguments>();
    CLI::App* command = app.add_subcommand(
        "convert", "Spherical harmonics from and to the conventions of DirectX, Unity, three.js, Filament and glTF");
    std::string names;
    for (const ShConvention& convention : sh_conventions())
        names += fmt::format("\n  {}: {}", convention.name, convention.description);
    command->footer("Conventions:" + names);
    command->add_option("FILE", options->input, "Coefficients: of lobelia encode, or of the convention --from names")
        ->required();
    command->add_option("--from", options->from, "The convention of the file (default: ours)");
    CLI::Option* to = command->add_option("--to", options->to, "The convention to write (default: ours)");
    command
        ->add_option("--mirror", options->mirror,
                     "Turn one axis round: between right-handed worlds, as ours, and left-handed ones")
        ->check(CLI::IsMember({"x", "y", "z"}));
    command
        ->add_option("--codec", options->codec,
                     "The codec that the written file names (default: the first of the list that has its degree)")
        ->transform(CLI::Validator(replace_lobe_file, ""))
        ->excludes(to);
    command->add_option("-o,--output", options->out, "The file to write")->required();
    return {command, [options] { return convert_verb(*options); }};
}

}  // namespace lobelia::cli
