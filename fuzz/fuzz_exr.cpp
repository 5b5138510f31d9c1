// Feeds any bytes to the OpenEXR reader. See CMakeLists.txt for how to run it.
#include "check_loaded.h"
#include "io/read_exr_channels.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lobelia;
    const auto bytes = bytes_of(data, size);
    check_loaded(read_exr(bytes, "fuzz", k_fuzz_options));
    const auto planes = read_exr_channels(bytes, "fuzz", {.most_pixels = 1 << 16, .most_values = 1 << 18});
    if (check_result(planes))
        for (const auto& plane : planes->planes) require(plane.size() == planes->width * planes->height);
    return 0;
}
