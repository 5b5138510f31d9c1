// Whether the checkpoint in a folder can be continued by a bake.
#pragma once

#include <filesystem>

#include "bake/session/checkpoint.h"
#include "bake/session/setup.h"

namespace lobelia {

/// Returns the header of a region's states before their first pass.
[[nodiscard]] RegionHeader expected_header(const BakeSetup& setup, std::size_t region,
                                           std::span<const std::uint32_t> texels);

/// An error unless the header of a file of states is that of the same region of the same bake, at whatever pass.
[[nodiscard]] Status check_header(const std::filesystem::path& file, const RegionHeader& is,
                                  const RegionHeader& expected);

/// Checks the headers of all states in a bake's folder before anything there is changed. Besides states of another
/// bake, it is an error if there are none because objects were baked again, and if the setup has more samples than the
/// job in the folder while the states do not hold all of that job's: the samples would be added twice.
[[nodiscard]] Status check_continuation(const BakeSetup& setup, const std::filesystem::path& folder);

/// The error of starting afresh in a folder that holds states.
[[nodiscard]] Error earlier_checkpoint(const std::filesystem::path& folder);

}  // namespace lobelia
