// Probes as two files: probes.json says what there is, probes.bin holds the coefficients, float32 little-endian.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "bake/write/bake_files.h"
#include "io/staged_file.h"
#include "lobelia/lightmap.h"

namespace lobelia {

inline constexpr int k_probes_version = 1;

/// The text of the JSON file, which names the file of the coefficients and, where the probes have maps, of visibility.
[[nodiscard]] std::string to_json_text(const ProbeSet& probes, std::string_view binary_file,
                                       std::string_view visibility_file = {});
/// The binary file: red, green, blue of coefficient after coefficient, probe after probe.
[[nodiscard]] Status write_probe_coefficients(StagedFile& file, const ProbeSet& probes);
/// The maps of visibility: mean and mean square of each texel, row by row, probe after probe.
[[nodiscard]] Status write_probe_visibility(StagedFile& file, const ProbeSet& probes);

/// Content of the JSON file: probes without their coefficients, and the name of the file with the coefficients.
struct ProbeDescription {
    ProbeSet probes;
    std::string file;
    std::optional<std::string> visibility;
};
[[nodiscard]] Result<ProbeDescription> probes_from_json(std::string_view text, const std::string& name);

/// Reads both files, by the name of the JSON file. Errors name the file and the place in it.
[[nodiscard]] Result<ProbeSet> read_probes(const BakeFiles& files, const std::string& name);

}  // namespace lobelia
