// Feeds any bytes to the reader of ordinary pictures. See CMakeLists.txt for how to run it.
#include "check_loaded.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::span<const std::byte> bytes(reinterpret_cast<const std::byte*>(data), size);
    lobelia::check_loaded(lobelia::read_ldr(bytes, "fuzz", lobelia::k_fuzz_options));
    return 0;
}
