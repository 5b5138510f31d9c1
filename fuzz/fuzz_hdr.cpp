// Feeds any bytes to the Radiance reader. See CMakeLists.txt for how to run it.
#include "check_loaded.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lobelia;
    check_loaded(read_hdr(bytes_of(data, size), "fuzz", k_fuzz_options));
    return 0;
}
