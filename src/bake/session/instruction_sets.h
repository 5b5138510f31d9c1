// The instruction sets that states were made with: their last bits depend on them.
#pragma once

#include <cstdint>
#include <string>

namespace lobelia {

/// Up to four different instruction sets, a byte each from the lowest on: simd_target_id, or 0.
using InstructionSets = std::uint32_t;

/// Returns those of either.
[[nodiscard]] InstructionSets joined(InstructionSets a, InstructionSets b);
[[nodiscard]] constexpr bool are_several(InstructionSets sets) { return sets > 0xff; }
/// Returns the warning about states of several instruction sets; it names them and the way to agree on one.
[[nodiscard]] std::string several_sets_warning(InstructionSets sets);

}  // namespace lobelia
