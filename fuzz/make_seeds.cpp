// Writes a seed corpus: small valid files of every kind, into FOLDER/hdr, FOLDER/exr and so on.
#include <cstdio>
#include <filesystem>

#include "bake/write/manifest.h"
#include "bake/write/probe_files.h"
#include "bake_files.h"
#include "gltf_files.h"
#include "hostile_numbers.h"
#include "io/write_file.h"
#include "io/write_image.h"
#include "io_files.h"
#include "lobelia/gltf.h"
#include "lobelia/storage.h"
#include "picture_files.h"
#include "scene/embedded.h"

namespace {

using namespace lobelia;

bool write(const std::filesystem::path& folder, const std::string& name, const std::string& bytes) {
    const Status status = write_file_atomically(folder / name, bytes);
    if (!status) std::fprintf(stderr, "%s\n", status.error().message.c_str());
    return static_cast<bool>(status);
}

bool write_hdr_seeds(const std::filesystem::path& folder) {
    bool done = true;
    const HdrTexels picture = test_texels(20, 3);
    using Scheme = HdrSpec::Scheme;
    for (const Scheme scheme : {Scheme::flat, Scheme::old_rle, Scheme::new_rle})
        for (const std::string axes : {"-Y +X", "+Y +X", "-Y -X", "+Y -X", "+X -Y", "-X -Y", "+X +Y", "-X +Y"})
            done &= write(folder, "scheme" + std::to_string(static_cast<int>(scheme)) + axes,
                          make_hdr(picture, {scheme, axes, "FORMAT=32-bit_rle_rgbe\n"}));
    const std::string variables =
        "# comment\nEXPOSURE= 2.5\nCOLORCORR=1 0.5 2\nPRIMARIES=0.64 0.33 0.29 0.6 0.15 0.06 0.3127 0.329\n"
        "FORMAT=32-bit_rle_xyze\n";
    done &= write(folder, "xyze", make_hdr(picture, {Scheme::new_rle, "-Y +X", variables}));
    return done;
}

bool write_exr_seeds(const std::filesystem::path& folder) {
    bool done = true;
    const Image image = test_image(20, 10);
    for (int compression = 0; compression < Imf::NUM_COMPRESSION_METHODS; ++compression) {
        for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT, Imf::UINT}) {
            for (const ExrSpec::Layout layout : {ExrSpec::Layout::scan_lines, ExrSpec::Layout::tiles}) {
                const ExrSpec spec{layout, static_cast<Imf::Compression>(compression), type, {"R", "G", "B"}, 0, 0};
                const std::string name = "compression" + std::to_string(compression) + "-type" + std::to_string(type) +
                                         "-layout" + std::to_string(static_cast<int>(layout));
                done &= write(folder, name, make_exr(image, spec));
            }
        }
    }
    done &= write(folder, "mipmap", make_exr(image, {.layout = ExrSpec::Layout::mipmap}));
    done &= write(folder, "ripmap", make_exr(image, {.layout = ExrSpec::Layout::ripmap}));
    done &= write(folder, "luminance", make_exr(image, {.channels = {"Y"}, .left = -3, .top = 5}));
    done &= write(folder, "layers", make_exr(image, {.channels = {"left.R", "left.G", "left.B"}}));
    done &= write(folder, "luminance-chroma", make_luminance_chroma_exr(image));
    done &= write(folder, "multi-part", make_multi_part_exr(image, {{"Z"}, {"R", "G", "B", "A"}}));
    done &= write(folder, "deep", make_deep_exr());
    done &= write(folder, "windows", make_exr(image, {.left = 4, .display = std::array{0, -2, 15, 20}}));
    done &= write(folder, "latitude-longitude", make_exr(image, {.envmap = Imf::ENVMAP_LATLONG}));
    done &= write(folder, "cube", make_exr(test_image(4, 24), {.envmap = Imf::ENVMAP_CUBE}));
    return done;
}

bool write_png_seeds(const std::filesystem::path& folder) {
    using Colours = PngSpec::Colours;
    bool done = true;
    for (const bool interlaced : {false, true})
        for (const bool transparent : {false, true})
            for (const PngSpec& spec : {PngSpec{Colours::grey, 1, interlaced, transparent},
                                        {Colours::grey, 16, interlaced, transparent},
                                        {Colours::palette, 4, interlaced, transparent},
                                        {Colours::rgb, 8, interlaced, transparent},
                                        {Colours::rgba, 16, interlaced, false}}) {
                const std::string name = std::to_string(static_cast<int>(spec.colours)) + "-" +
                                         std::to_string(spec.bits) + (interlaced ? "-interlaced" : "") +
                                         (transparent ? "-transparent" : "");
                done &= write(folder, name + ".png", make_png(15, 10, spec).bytes);
            }
    return done;
}

bool write_jpeg_seeds(const std::filesystem::path& folder) {
    using Colours = JpegSpec::Colours;
    using Scans = JpegSpec::Scans;
    bool done = true;
    const TestPicture picture = test_picture(15, 10);
    for (const Colours colours : {Colours::grey, Colours::ycc, Colours::rgb, Colours::cmyk, Colours::ycck})
        for (const Scans scans : {Scans::interleaved, Scans::by_component, Scans::progressive}) {
            const std::string name =
                std::to_string(static_cast<int>(colours)) + "-" + std::to_string(static_cast<int>(scans));
            done &= write(folder, name + ".jpg", make_jpeg(picture, {.colours = colours, .scans = scans}));
        }
    return done && write(folder, "restart.jpg", make_jpeg(picture, {.restart_interval = 1})) &&
           write(folder, "arithmetic.jpg", make_jpeg(picture, {.arithmetic = true}));
}

bool write_ldr_seeds(const std::filesystem::path& folder) {
    const TestPicture opaque = test_picture(15, 10), transparent = test_picture(15, 10, Alpha::transparent);
    return write_png_seeds(folder) && write_jpeg_seeds(folder) && write(folder, "opaque.webp", make_webp(opaque)) &&
           write(folder, "transparent.webp", make_webp(transparent)) &&
           write(folder, "lossy.webp", make_webp(opaque, {.lossless = false})) &&
           write(folder, "lossy-transparent.webp", make_webp(transparent, {.lossless = false})) &&
           write(folder, "animated.webp", make_animated_webp());
}

bool write_gltf_seeds(const std::filesystem::path& folder) {
    const GltfFile square = square_file(), rich = rich_file();
    GltfFile external = square;
    external.root["buffers"] = nlohmann::json::array({{{"byteLength", 60}, {"uri", "data.bin"}}});
    external.binary.clear();
    return write(folder, "square.gltf", square.gltf()) && write(folder, "square.glb", square.glb()) &&
           write(folder, "rich.gltf", rich.gltf()) && write(folder, "rich.glb", rich.glb()) &&
           write(folder, "external.gltf", external.gltf()) &&
           write(folder, "cornell.glb", encode_glb(cornell_scene()).value());
}

bool write_bake_seeds(const std::filesystem::path& folder) {
    const Bake world = test::some_bake("sh1/moments/convolution"),
               tangent = test::some_bake("sg12h/moments/exact", Frame::tangent);
    Manifest textured = world.manifest;
    const CoefficientTraits traits = coefficient_traits(*make_codec(textured.options.codec)->encoder());
    PageEntry page{"page-0.exr", {}, "page-0.validity.ktx2"};
    for (const auto& texture : find_storage("ratio8").value()->layout(traits).textures)
        page.textures.push_back({"ratio8", "page-0." + texture.name + ".ktx2", texture});
    textured.pages = {page, {"page-1.exr", {}, {}}};
    Manifest plain = tangent.manifest;
    plain.pages = {{"page-0.exr", {}, {}}, {"page-1.exr", {}, {}}};
    return write(folder, "bake", to_json_text(textured)) && write(folder, "plain", to_json_text(plain)) &&
           write(folder, "probes", to_json_text(*world.probes, "probes.bin"));
}

/// Each call of fuzz_api with tame and with hostile numbers.
bool write_api_seeds(const std::filesystem::path& folder) {
    bool done = true;
    std::vector<float> tame(64);
    for (std::size_t i = 0; i < tame.size(); ++i) tame[i] = 0.1f + 0.01f * static_cast<float>(i);
    for (unsigned char what = 0; what < 6; ++what)
        for (const unsigned char which : {0, 7, 14, 21, 28, 35, 255})
            for (const std::span<const float> numbers : {std::span<const float>(tame), {test::k_hostile_numbers}}) {
                std::string bytes = {static_cast<char>(what), static_cast<char>(which), static_cast<char>(which / 3)};
                bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes());
                done &= write(folder,
                              std::to_string(what) + "-" + std::to_string(which) + "-" + std::to_string(numbers.size()),
                              bytes);
            }
    return done;
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 2) {
        std::fprintf(stderr, "usage: make_seeds FOLDER\n");
        return 2;
    }
    const std::filesystem::path folder = arguments[1];
    for (const char* kind : {"hdr", "exr", "ldr", "gltf", "bake", "api"})
        std::filesystem::create_directories(folder / kind);
    const bool done = write_hdr_seeds(folder / "hdr") && write_exr_seeds(folder / "exr") &&
                      write_ldr_seeds(folder / "ldr") && write_gltf_seeds(folder / "gltf") &&
                      write_bake_seeds(folder / "bake") && write_api_seeds(folder / "api");
    return done ? 0 : 1;
}
