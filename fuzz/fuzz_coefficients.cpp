// Feeds any bytes to the readers of coefficients: Lobelia's own files, those of other conventions, files of lobes. What
// they hold is evaluated. See CMakeLists.txt for how to run it.
#include "check_loaded.h"
#include "coefficients/coefficient_file.h"
#include "coefficients/convert.h"
#include "lobelia/bases.h"
#include "lobelia/sampling.h"
#include "lobelia/sh_conventions.h"

namespace {

using namespace lobelia;

void evaluate(const CoefficientFile& file) {
    const auto codec = make_codec(file.codec.str());
    require(static_cast<bool>(codec) && codec->basis().size() == file.c.size());
    const Directions directions = uniform_directions(codec->basis().domain(), Sequence::sobol, 20, 1);
    Colours values(directions.size());
    codec->radiance(file.c, directions, values);
    codec->irradiance(file.c, directions, values);
}

void check_coefficients(std::string_view text) {
    const auto file = coefficients_from_text(text, "fuzz");
    if (!check_result(file)) return;
    evaluate(*file);
    const std::string again = to_text(*file);
    const auto second = coefficients_from_text(again, "again");
    require(static_cast<bool>(second) && to_text(*second) == again);
}

/// Converts from and to every convention; files that were written can be read.
void check_conventions(std::string_view text) {
    for (const ShConvention& convention : sh_conventions()) {
        const std::string name(convention.name);
        const auto ours = convert(text, "fuzz", {.from = name, .mirrored = Axis::z});
        if (check_result(ours)) require(static_cast<bool>(coefficients_from_text(ours->text, "ours")));
        const auto theirs = convert(text, "fuzz", {.to = name});
        if (check_result(theirs)) check_result(convert(theirs->text, "theirs", {.from = name}));
    }
}

void check_lobes(std::string_view text) {
    auto lobes = parse_lobes(text, "fuzz");
    if (!check_result(lobes)) return;
    const auto basis = spherical_gaussians(*std::move(lobes), Domain::sphere);
    check_result(make_basis(basis->name()));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = text_of(data, size);
    check_coefficients(text);
    check_conventions(text);
    check_lobes(text);
    return 0;
}
