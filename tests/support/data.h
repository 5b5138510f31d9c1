// Locations of environments and files that are not part of the project.
#pragma once

#include <filesystem>

namespace lobelia::test {

/// Returns the folder named by the environment variable LOBELIA_DATA, or else ../shared/data beside the checkout.
[[nodiscard]] std::filesystem::path data_folder();
/// Returns the folder "cases" beside it: small inputs that once failed.
[[nodiscard]] std::filesystem::path cases_folder();

}  // namespace lobelia::test
