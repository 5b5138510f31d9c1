// Where the tests find environments that do not come with the project.
#pragma once

#include <filesystem>

namespace lobelia::test {

/// The folder that the environment variable LOBELIA_DATA names, or else ../shared/data beside the checkout.
[[nodiscard]] std::filesystem::path data_folder();

}  // namespace lobelia::test
