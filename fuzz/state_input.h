// How fuzz_state takes its input, and make_seeds makes it.
#pragma once

#include <cstdint>

namespace lobelia {

/// The first byte of an input. Then follows a whole file; or a RegionHeader and states, written with a checksum that is
/// right, behind that header or behind one that belongs to the bake.
enum class StateInput : std::uint8_t { whole_file, any_header, of_the_bake };

}  // namespace lobelia
