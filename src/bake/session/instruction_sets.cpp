// Sets of instruction sets in 32 bits.
#include "bake/session/instruction_sets.h"

#include <fmt/format.h>

#include "lobelia/simd.h"

namespace lobelia {

InstructionSets joined(InstructionSets a, InstructionSets b) {
    for (; b != 0; b >>= 8) {
        // Insert the next one at the first free byte, unless it is there already. A fifth is left out.
        const InstructionSets id = b & 0xff;
        for (int shift = 0; shift < 32; shift += 8) {
            const InstructionSets there = a >> shift & 0xff;
            if (there == 0) a |= id << shift;
            if (there == 0 || there == id) break;
        }
    }
    return a;
}

std::string several_sets_warning(InstructionSets sets) {
    std::string names;
    for (; sets != 0; sets >>= 8) names += (names.empty() ? "" : ", ") + std::string(simd_target_name(sets & 0xff));
    return fmt::format(
        "parts of this bake come from machines with different instruction sets ({}); the last bits of the pages differ "
        "from those of a bake on one of them. For the same bits, set LOBELIA_SIMD to one that all machines have",
        names);
}

}  // namespace lobelia
