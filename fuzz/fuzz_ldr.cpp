// Feeds any bytes to the readers of PNG, JPEG and WebP. See CMakeLists.txt for how to run it.
#include "check_loaded.h"
#include "io/read_picture.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lobelia;
    const std::span<const std::byte> bytes(reinterpret_cast<const std::byte*>(data), size);
    check_loaded(read_ldr(bytes, "fuzz", k_fuzz_options));
    const auto picture = read_picture_rgba8(bytes, "fuzz", k_fuzz_options.most_pixels);
    if (picture)
        require(picture->texels.size() == picture->width * picture->height && !picture->texels.empty());
    else
        require(picture.error().message.starts_with("fuzz: "));
    return 0;
}
