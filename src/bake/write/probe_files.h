// Probes as two files: probes.json says what there is, probes.bin holds the coefficients, float32 little-endian.
#pragma once

#include <string>
#include <string_view>

#include "bake/write/bake_files.h"
#include "io/staged_file.h"
#include "lobelia/lightmap.h"

namespace lobelia {

inline constexpr int k_probes_version = 1;

/// The text of the JSON file, which names `binary_file`.
[[nodiscard]] std::string to_json_text(const ProbeSet& probes, std::string_view binary_file);
/// The binary file: red, green, blue of coefficient after coefficient, probe after probe.
[[nodiscard]] Status write_probe_coefficients(StagedFile& file, const ProbeSet& probes);

/// Content of the JSON file: probes without their coefficients, and the name of the file with the coefficients.
struct ProbeDescription {
    ProbeSet probes;
    std::string file;
};
[[nodiscard]] Result<ProbeDescription> probes_from_json(std::string_view text, const std::string& name);

/// Reads both files, by the name of the JSON file. Errors name the file and the place in it.
[[nodiscard]] Result<ProbeSet> read_probes(const BakeFiles& files, const std::string& name);

}  // namespace lobelia
