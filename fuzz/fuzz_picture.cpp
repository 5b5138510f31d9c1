// Feeds any bytes to the reader of one picture format: fuzz_png, fuzz_jpeg and fuzz_webp are this file with one of
// LOBELIA_FUZZ_PNG, LOBELIA_FUZZ_JPEG and LOBELIA_FUZZ_WEBP defined. See CMakeLists.txt for how to run them.
#include "check_loaded.h"
#include "io/decode_picture.h"
#include "io/read_picture.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lobelia;
    const auto bytes = bytes_of(data, size);
    // Leave other formats to their own fuzzers.
#if defined(LOBELIA_FUZZ_PNG)
    constexpr auto k_format = io::PictureFormat::png;
#elif defined(LOBELIA_FUZZ_JPEG)
    constexpr auto k_format = io::PictureFormat::jpeg;
#else
    constexpr auto k_format = io::PictureFormat::webp;
#endif
    if (io::picture_format(bytes) != k_format) return 0;
    check_loaded(read_ldr(bytes, "fuzz", k_fuzz_options));
    const auto picture = read_picture_rgba8(bytes, "fuzz", k_fuzz_options.most_pixels);
    if (picture)
        require(picture->texels.size() == picture->width * picture->height && !picture->texels.empty());
    else
        require(picture.error().message.starts_with("fuzz: "));

    // Decode again into texels that hold other bytes: the decoder must have written all of them.
    const auto again = io::decode_picture(
        bytes, "fuzz", {k_fuzz_options.most_pixels, io::PictureOptions::Depth::eight, std::uint8_t{0xa5}});
    require(static_cast<bool>(again) == static_cast<bool>(picture));
    if (again) require(std::get<std::vector<io::Rgba8>>(again->texels) == picture->texels);
    return 0;
}
