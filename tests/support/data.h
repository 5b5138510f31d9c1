// Where the tests find environments and files that do not come with the project.
#pragma once

#include <filesystem>

namespace lobelia::test {

/// The folder that the environment variable LOBELIA_DATA names, or else ../shared/data beside the checkout.
[[nodiscard]] std::filesystem::path data_folder();
/// The folder "cases" beside that one: small inputs that once failed.
[[nodiscard]] std::filesystem::path cases_folder();

}  // namespace lobelia::test
