// The instruction set that the kernels use. Results differ between instruction sets in the last bits (docs/baking.md).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lobelia/result.h"

namespace lobelia {

/// Names of the instruction sets that this build has kernels for and this machine can run, the fastest first: of "AVX3"
/// (AVX-512), "AVX2", "SSE4", "NEON" and so on, and always "SCALAR", which every machine has.
[[nodiscard]] std::vector<std::string> simd_targets();
/// The one in use: the fastest, unless use_simd_target chose another.
[[nodiscard]] std::string_view simd_target();
/// Uses one of simd_targets() from now on, in the whole process; call it before any other work. The error of an unknown
/// name, or of one that this machine lacks, lists those.
[[nodiscard]] Status use_simd_target(std::string_view name);

/// The one in use as a number that files keep, above 0; it is the same on every machine and in every build.
[[nodiscard]] std::uint32_t simd_target_id();
/// The name of such a number, "an unknown instruction set" for others.
[[nodiscard]] std::string_view simd_target_name(std::uint32_t id);

}  // namespace lobelia
