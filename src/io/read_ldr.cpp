// 8- and 16-bit pictures through stb_image: decoded from sRGB to linear, or as they are for textures.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_NO_HDR
#define STBI_NO_LINEAR
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_BMP
#define STBI_MAX_DIMENSIONS 65536
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#include <stb/stb_image.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

#include <fmt/format.h>

#include <cstring>
#include <limits>
#include <memory>

#include "core/math/colour.h"
#include "io/image_checks.h"
#include "io/jpeg_check.h"
#include "io/png_check.h"
#include "io/read_picture.h"

namespace lobelia {

namespace {

struct PictureInfo {
    int width = 0, height = 0;
};

/// The bytes as stb_image takes them.
struct StbBytes {
    const stbi_uc* data;
    int size;
};

template <class Sample>
using StbSamples = std::unique_ptr<Sample, void (*)(void*)>;

template <class Sample>
Image decoded(const Sample* samples, PictureInfo info) {
    // Tabulate the curve: there are at most 65536 different samples.
    constexpr std::size_t k_levels = std::size_t{std::numeric_limits<Sample>::max()} + 1;
    std::vector<float> linear(k_levels);
    for (std::size_t i = 0; i < k_levels; ++i)
        linear[i] = static_cast<float>(linear_from_srgb(static_cast<double>(i) / (k_levels - 1)));

    Image image(static_cast<std::size_t>(info.width), static_cast<std::size_t>(info.height));
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = {linear[samples[3 * i]], linear[samples[3 * i + 1]], linear[samples[3 * i + 2]]};
    return image;
}

Status check_picture(std::span<const std::byte> bytes, std::string_view name, PictureInfo info,
                     const ReadOptions& options) {
    if (const Status status = io::check_size(name, info.width, info.height, options); !status) return status;
    // PNG packs at best 8 pixels into a byte, and deflates 1032 : 1; the others do not compress as well.
    constexpr std::size_t k_most_pixels_per_byte = 8 * 1032;
    const std::size_t pixels = static_cast<std::size_t>(info.width) * static_cast<std::size_t>(info.height);
    if (pixels / k_most_pixels_per_byte > bytes.size())
        return Error{
            fmt::format("{}: {} bytes cannot hold {} x {} pixels", name, bytes.size(), info.width, info.height)};
    return Done{};
}

Result<Image> decode(StbBytes source, std::string_view name) {
    PictureInfo info;
    int channels = 0;
    if (stbi_is_16_bit_from_memory(source.data, source.size)) {
        const StbSamples<stbi_us> samples(
            stbi_load_16_from_memory(source.data, source.size, &info.width, &info.height, &channels, 3),
            stbi_image_free);
        if (samples) return decoded(samples.get(), info);
    } else {
        const StbSamples<stbi_uc> samples(
            stbi_load_from_memory(source.data, source.size, &info.width, &info.height, &channels, 3), stbi_image_free);
        if (samples) return decoded(samples.get(), info);
    }
    return Error{fmt::format("{}: a damaged picture: {}", name, stbi_failure_reason())};
}

/// What is wrong with the parts that a file is made of, where its decoder would trust them.
std::optional<std::string_view> problem_of(std::span<const std::byte> bytes) {
    if (bytes.empty()) return std::nullopt;
    if (bytes[0] == std::byte{0xff}) return io::jpeg_problem(bytes);
    if (bytes[0] == std::byte{0x89}) return io::png_problem(bytes);
    return std::nullopt;
}

/// Checks the parts and the size before anything is allocated.
Result<StbBytes> checked(std::span<const std::byte> bytes, std::string_view name, const ReadOptions& options) {
    if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
        return Error{fmt::format("{}: the picture file is larger than 2 GiB", name)};
    if (const auto problem = problem_of(bytes)) return Error{fmt::format("{}: a damaged picture: {}", name, *problem)};
    const StbBytes source{reinterpret_cast<const stbi_uc*>(bytes.data()), static_cast<int>(bytes.size())};
    PictureInfo info;
    int channels = 0;
    if (!stbi_info_from_memory(source.data, source.size, &info.width, &info.height, &channels))
        return Error{fmt::format("{}: a damaged picture: {}", name, stbi_failure_reason())};
    if (const Status status = check_picture(bytes, name, info, options); !status) return status.error();
    return source;
}

/// What bytes that are neither PNG nor JPEG seem to be.
std::string_view other_format(std::string_view text) {
    if (text.empty()) return "empty";
    if (text.starts_with("\xabKTX ")) return "a KTX file, which is not read as a texture";
    if (text.starts_with("RIFF") && text.find("WEBP") == 8) return "a WebP picture, which is not read";
    if (text.starts_with("DDS ")) return "a DDS file, which is not read";
    return "neither PNG nor JPEG";
}

}  // namespace

Result<PictureRgba8> read_picture_rgba8(std::span<const std::byte> bytes, std::string_view name,
                                        std::size_t most_pixels) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (!text.starts_with("\x89PNG") && !text.starts_with("\xff\xd8\xff"))
        return Error{fmt::format("{}: {}", name, other_format(text))};
    ReadOptions options;
    options.most_pixels = most_pixels;
    const Result<StbBytes> source = checked(bytes, name, options);
    if (!source) return source.error();
    int width = 0, height = 0, channels = 0;
    const StbSamples<stbi_uc> samples(stbi_load_from_memory(source->data, source->size, &width, &height, &channels, 4),
                                      stbi_image_free);
    if (!samples) return Error{fmt::format("{}: a damaged picture: {}", name, stbi_failure_reason())};
    PictureRgba8 picture{static_cast<std::size_t>(width), static_cast<std::size_t>(height), {}};
    picture.texels.resize(picture.width * picture.height);
    std::memcpy(picture.texels.data(), samples.get(), 4 * picture.texels.size());
    return picture;
}

Result<LoadedImage> read_ldr(std::span<const std::byte> bytes, std::string_view name, const ReadOptions& options) {
    if (!options.ldr)
        return Error{
            fmt::format("{}: a picture without high dynamic range, in which suns and lamps are cut off at white; "
                        "pass --ldr to use it all the same",
                        name)};
    const Result<StbBytes> source = checked(bytes, name, options);
    if (!source) return source.error();
    Result<Image> image = decode(*source, name);
    if (!image) return image.error();
    return io::inspected({std::move(*image), {}, {}}, name, options);
}

}  // namespace lobelia
