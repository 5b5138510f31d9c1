// Writes a seed corpus: small valid files of every kind, into FOLDER/hdr, FOLDER/exr and so on.
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#endif
#include <stb/stb_image_write.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

#include <cstdio>
#include <filesystem>

#include "bake/write/probe_files.h"
#include "bake_files.h"
#include "gltf_files.h"
#include "io/write_file.h"
#include "io/write_image.h"
#include "io_files.h"
#include "lobelia/storage.h"
#include "scene/embedded.h"
#include "scene/gltf_write.h"

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
    return done;
}

bool write_ldr_seeds(const std::filesystem::path& folder) {
    const Image8 picture = to_srgb(test_image(20, 10), 0.02f);
    const auto append = [](void* target, void* data, int size) {
        static_cast<std::string*>(target)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
    };
    // The same bytes as pictures of 1 to 4 channels.
    bool done = true;
    for (int channels = 1; channels <= 4; ++channels) {
        std::string png, jpeg, bmp;
        const void* data = picture.rgb.data();
        done &= stbi_write_png_to_func(append, &png, 15, 10, channels, data, 15 * channels) != 0;
        done &= stbi_write_jpg_to_func(append, &jpeg, 15, 10, channels, data, 70 + 10 * channels) != 0;
        done &= stbi_write_bmp_to_func(append, &bmp, 15, 10, channels, data) != 0;
        const std::string name = std::to_string(channels);
        done &= write(folder, name + ".png", png) && write(folder, name + ".jpg", jpeg) &&
                write(folder, name + ".bmp", bmp);
    }
    return done;
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

}  // namespace

int main(int count, char** arguments) {
    if (count != 2) {
        std::fprintf(stderr, "usage: make_seeds FOLDER\n");
        return 2;
    }
    const std::filesystem::path folder = arguments[1];
    for (const char* kind : {"hdr", "exr", "ldr", "gltf", "bake"}) std::filesystem::create_directories(folder / kind);
    const bool done = write_hdr_seeds(folder / "hdr") && write_exr_seeds(folder / "exr") &&
                      write_ldr_seeds(folder / "ldr") && write_gltf_seeds(folder / "gltf") &&
                      write_bake_seeds(folder / "bake");
    return done ? 0 : 1;
}
