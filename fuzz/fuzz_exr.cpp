// Feeds any bytes to the OpenEXR reader. See CMakeLists.txt for how to run it.
#include "check_loaded.h"
#include "io/read_exr_channels.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::span<const std::byte> bytes(reinterpret_cast<const std::byte*>(data), size);
    lobelia::check_loaded(lobelia::read_exr(bytes, "fuzz", lobelia::k_fuzz_options));
    const auto planes = lobelia::read_exr_channels(bytes, "fuzz", {.most_pixels = 1 << 16, .most_values = 1 << 18});
    if (planes)
        for (const auto& plane : planes->planes) lobelia::require(plane.size() == planes->width * planes->height);
    else
        lobelia::require(!planes.error().message.empty());
    return 0;
}
