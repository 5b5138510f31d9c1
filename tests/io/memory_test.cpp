// Image readers and memory: no pixel and no message depends on what allocated memory held before, and no size in a file
// is allocated before it is checked. A program of its own, because it replaces malloc.
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <random>

#include "io/decode_picture.h"
#include "io/read_image.h"
#include "io_files.h"
#include "picture_files.h"

namespace {
unsigned char heap_fill = 0;      // Every byte of memory that malloc returns.
std::size_t largest_request = 0;  // In bytes.

void* filled(void* memory, std::size_t size, std::size_t from = 0) {
    largest_request = std::max(largest_request, size);
    if (memory != nullptr && from < size) std::memset(static_cast<char*>(memory) + from, heap_fill, size - from);
    return memory;
}
}  // namespace

// The allocator of the C library, by its other names.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) noexcept { return filled(__libc_malloc(size), size); }
void* realloc(void* memory, std::size_t size) noexcept {
    const std::size_t before = memory != nullptr ? malloc_usable_size(memory) : 0;
    return filled(__libc_realloc(memory, size), size, before);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
    return filled(__libc_memalign(alignment, size), size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
    *memory = aligned_alloc(alignment, size);
    return *memory != nullptr ? 0 : ENOMEM;
}
}

namespace lobelia {
namespace {

using namespace std::string_literals;

constexpr std::size_t k_most_pixels = 1 << 16;

std::span<const std::byte> bytes_of(const std::string& file) { return std::as_bytes(std::span(file)); }

/// All that a reader returns: the message, or size and pixels.
std::string decoded(const std::string& file, std::uint8_t fill) {
    using Depth = io::PictureOptions::Depth;
    const auto picture = io::decode_picture(bytes_of(file), "file", {k_most_pixels, Depth::stored, fill});
    if (!picture) return picture.error().message;
    std::string result = std::to_string(picture->width) + " x " + std::to_string(picture->height) + ": ";
    std::visit(
        [&](const auto& texels) {
            result.append(reinterpret_cast<const char*>(texels.data()), texels.size() * sizeof texels[0]);
        },
        picture->texels);
    return result;
}

std::string as_environment(const std::string& file) {
    const auto loaded =
        read_environment(bytes_of(file), "file", {.ldr = true, .sanitize = true, .most_pixels = k_most_pixels});
    if (!loaded) return loaded.error().message;
    std::string result = std::to_string(loaded->image.width) + " x " + std::to_string(loaded->image.height) + ": ";
    result.append(reinterpret_cast<const char*>(loaded->image.pixels.data()),
                  loaded->image.pixels.size() * sizeof(Rgb));
    return result;
}

/// Reads a file in two ways, twice each, on memory that holds different bytes.
void expect_the_same_from_any_memory(const std::string& file, const std::string& what) {
    heap_fill = 0x11;
    const std::string picture = decoded(file, 0x11), environment = as_environment(file);
    heap_fill = 0xee;
    EXPECT_TRUE(decoded(file, 0xee) == picture) << what;
    EXPECT_TRUE(as_environment(file) == environment) << what << ": " << environment.substr(0, 200);
    heap_fill = 0;
}

/// A file of each kind, by name.
std::vector<std::pair<std::string, std::string>> files() {
    const TestPicture picture = test_picture(19, 10, Alpha::transparent);
    std::vector<std::pair<std::string, std::string>> files;
    using Png = PngSpec::Colours;
    for (const bool interlaced : {false, true})
        for (const PngSpec& spec : {PngSpec{Png::grey, 1, interlaced, true},
                                    {Png::palette, 4, interlaced, true},
                                    {Png::rgb, 8, interlaced, false},
                                    {Png::rgba, 16, interlaced, false}})
            files.emplace_back("png", make_png(19, 10, spec).bytes);
    using Colours = JpegSpec::Colours;
    using Scans = JpegSpec::Scans;
    for (const Scans scans : {Scans::interleaved, Scans::by_component, Scans::progressive})
        for (const Colours colours : {Colours::grey, Colours::ycc, Colours::ycck})
            files.emplace_back("jpeg", make_jpeg(picture, {.colours = colours, .scans = scans}));
    files.emplace_back("jpeg, restarts", make_jpeg(picture, {.restart_interval = 1}));
    files.emplace_back("jpeg, arithmetic", make_jpeg(picture, {.arithmetic = true}));
    files.emplace_back("webp", make_webp(picture));
    files.emplace_back("webp, lossy", make_webp(picture, {.lossless = false}));
    const Image image = test_image(20, 10);
    for (int compression = 0; compression < Imf::NUM_COMPRESSION_METHODS; ++compression)
        for (const ExrSpec::Layout layout : {ExrSpec::Layout::scan_lines, ExrSpec::Layout::tiles})
            files.emplace_back(
                "exr, compression " + std::to_string(compression) + (layout == ExrSpec::Layout::tiles ? ", tiles" : ""),
                make_exr(image, {layout, static_cast<Imf::Compression>(compression)}));
    files.emplace_back("exr, chroma", make_luminance_chroma_exr(image));
    files.emplace_back("exr, windows", make_exr(image, {.left = 4, .display = std::array{0, -2, 15, 20}}));
    using Scheme = HdrSpec::Scheme;
    for (const Scheme scheme : {Scheme::flat, Scheme::old_rle, Scheme::new_rle})
        files.emplace_back("hdr", make_hdr(test_texels(20, 3), {.scheme = scheme}));
    return files;
}

TEST(ImageMemory, WholeFilesReadTheSameFromAnyMemory) {
    for (const auto& [kind, file] : files()) expect_the_same_from_any_memory(file, kind);
}

TEST(ImageMemory, TruncatedFilesReadTheSameFromAnyMemory) {
    for (const auto& [kind, file] : files())
        for (std::size_t length = 0; length < file.size(); length += 1 + length / 40)
            expect_the_same_from_any_memory(file.substr(0, length), kind + ", " + std::to_string(length) + " bytes");
}

TEST(ImageMemory, DamagedFilesReadTheSameFromAnyMemory) {
    std::mt19937 generator(7);
    for (const auto& [kind, file] : files()) {
        // Chunks of OpenEXR that lose their length are rare.
        for (int round = 0; round < (kind.starts_with("exr") ? 1000 : 200); ++round) {
            std::string damaged = file;
            for (int k = 0; k < 2; ++k) damaged[generator() % damaged.size()] = static_cast<char>(generator());
            expect_the_same_from_any_memory(damaged, kind + ", round " + std::to_string(round));
        }
    }
}

TEST(ImageMemory, JpegWithoutTablesReadsTheSameFromAnyMemory) {
    const TestPicture picture = test_picture(19, 10);
    for (const std::uint8_t code : {std::uint8_t{0xc4}, std::uint8_t{0xdb}}) {
        const std::string file = jpeg_without(make_jpeg(picture), code);
        expect_the_same_from_any_memory(file, "without a table");
        EXPECT_EQ(decoded(file, 0).rfind("file: ", 0), 0u);
    }
}

/// Puts `text` into a file at a place.
std::string with(std::string file, std::size_t place, const std::string& text) {
    return file.replace(place, text.size(), text);
}

TEST(ImageMemory, SizesAreCheckedBeforeAllocation) {
    const TestPicture picture = test_picture(19, 10);
    std::vector<std::pair<std::string, std::string>> bombs;
    bombs.emplace_back("png", with(make_png(19, 10).bytes, 16, "\0\0\xff\xff\0\0\xff\xff"s));
    auto segments = split_jpeg(make_jpeg(picture));
    for (auto& segment : segments)
        if (segment.code == 0xc0) segment.bytes.replace(5, 4, "\xff\xdc\xff\xdc");
    bombs.emplace_back("jpeg", join_jpeg(segments));
    // 16384 x 16384 pixels, as the extended header of a WebP has them, and in the header of a lossless one.
    const std::string canvas = "\xff\x3f\0\xff\x3f\0"s, pixels = "\x2f\xff\xff\xff\x0f\0\0\0"s;
    bombs.emplace_back("webp, extended", "RIFF\x1e\0\0\0WEBPVP8X\x0a\0\0\0\0\0\0\0"s + canvas + "VP8L\0\0\0\0"s);
    bombs.emplace_back("webp, lossless", "RIFF\x14\0\0\0WEBPVP8L\x08\0\0\0"s + pixels);
    const std::string exr = make_exr(test_image(20, 10));
    const std::size_t window = exr.find("dataWindow") + 11 + 6 + 4;
    bombs.emplace_back("exr", with(exr, window, "\0\0\0\0\0\0\0\0\xff\xff\xff\x3f\xff\xff\xff\x3f"s));
    bombs.emplace_back("hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 65536 +X 65536\n"s + std::string(64, '\2'));
    for (const auto& [kind, file] : bombs) {
        largest_request = 0;
        const std::string message = as_environment(file);
        EXPECT_EQ(message.rfind("file: ", 0), 0u) << kind;
        // Much less than any of these sizes; decoders' own state takes up to 100 KB.
        EXPECT_LT(largest_request, std::size_t{1} << 18) << kind << ": " << message;
    }
}

}  // namespace
}  // namespace lobelia
