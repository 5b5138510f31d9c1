#include "data.h"

#include <cstdlib>

namespace lobelia::test {

std::filesystem::path data_folder() {
    const char* const folder = std::getenv("LOBELIA_DATA");
    return folder && *folder ? folder : LOBELIA_DEFAULT_DATA;
}

std::filesystem::path cases_folder() { return data_folder().parent_path() / "cases"; }

}  // namespace lobelia::test
