// Writes a seed corpus: small valid files of every kind, into FOLDER/hdr, FOLDER/exr and so on, a folder for each
// fuzzer. The folders of bakes that are given, too, become seeds of the fuzzer of bakes' folders.
#include <cstdio>
#include <filesystem>

#include "bake/session/checkpoint.h"
#include "bake/write/manifest.h"
#include "bake/write/probe_files.h"
#include "bake_files.h"
#include "bundle.h"
#include "coefficients/coefficient_file.h"
#include "coefficients/convert.h"
#include "gltf_files.h"
#include "hostile_numbers.h"
#include "io/write_file.h"
#include "io/write_image.h"
#include "io_files.h"
#include "lobelia/gltf.h"
#include "lobelia/sh_conventions.h"
#include "lobelia/storage.h"
#include "memory_folder.h"
#include "picture_files.h"
#include "scene/embedded.h"
#include "small_bake.h"
#include "state_input.h"

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

bool write_webp_seeds(const std::filesystem::path& folder) {
    const TestPicture opaque = test_picture(15, 10), transparent = test_picture(15, 10, Alpha::transparent);
    return write(folder, "opaque.webp", make_webp(opaque)) &&
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

bool write_manifest_seeds(const std::filesystem::path& folder) {
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
        for (const int which : {0, 7, 14, 21, 28, 35, 255})
            for (const std::span<const float> numbers : {std::span<const float>(tame), {test::k_hostile_numbers}}) {
                std::string bytes = {static_cast<char>(what), static_cast<char>(which), static_cast<char>(which / 3)};
                bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes());
                done &= write(folder,
                              std::to_string(what) + "-" + std::to_string(which) + "-" + std::to_string(numbers.size()),
                              bytes);
            }
    return done;
}

/// A file of every basis with the first of its codecs, the harmonics in every convention, and a file of lobes.
bool write_coefficients_seeds(const std::filesystem::path& folder) {
    bool done = write(folder, "lobes", "0 0 1 5 # up\n0 1 -1 2.5\nambient\n");
    std::string last;
    for (const CodecName& name : all_codecs()) {
        if (name.basis == last) continue;
        last = name.basis;
        CoefficientFile file{name, {}};
        const std::size_t size = make_codec(name.str()).value().basis().size();
        for (std::size_t i = 0; i < std::min<std::size_t>(size, 100); ++i)
            file.c.push_back({1.5f / static_cast<float>(i + 1), 0.25f, -0.125f * static_cast<float>(i % 3)});
        if (file.c.size() == size) done &= write(folder, name.basis, to_text(file));
    }
    const CoefficientFile nine{parse_codec_name("sh2/projection/convolution").value(), std::vector<Rgb>(9, {1, 2, 3})};
    for (const ShConvention& convention : sh_conventions()) {
        const auto converted = convert(to_text(nine), "seed", {.to = std::string(convention.name)});
        done &= converted && write(folder, std::string(convention.name), converted->text);
    }
    return done;
}

/// The files of states, jobs and whole folders that a bake leaves.
bool write_session_seeds(const std::filesystem::path& folder) {
    const MemoryFolder made;
    const Scene scene = small_scene();
    bool done = true;
    const auto bake_into = [&](const std::string& name, const BakeJob& job) {
        BakeSession session;
        session.folder = made.path() / name;
        const auto baked = bake(scene, job, session);
        if (!baked) std::fprintf(stderr, "%s\n", baked.error().message.c_str());
        done &= static_cast<bool>(baked);
        std::ifstream text(checkpoint_folder(session.folder) / "job.json");
        done &= write(folder / "job", name, {std::istreambuf_iterator<char>(text), {}});
        const std::filesystem::path states = region_file(checkpoint_folder(session.folder), 0);
        std::ifstream file(states, std::ios::binary);
        const std::string bytes{std::istreambuf_iterator<char>(file), {}};
        const auto input = [](StateInput kind) { return std::string(1, static_cast<char>(kind)); };
        done &= write(folder / "state", name, input(StateInput::whole_file) + bytes);
        const auto read = RegionStates::read(states);
        if (!read) return;
        std::string content(reinterpret_cast<const char*>(&read->header), sizeof read->header);
        content.append(reinterpret_cast<const char*>(read->states().data()), read->states().size_bytes());
        done &= write(folder / "state", name + "-header", input(StateInput::any_header) + content);
        done &= write(folder / "state", name + "-of-bake", input(StateInput::of_the_bake) + content);
    };
    BakeJob plain = small_job(), probes = small_job(), part = small_job();
    plain.bake.codec.clear();
    plain.precision = Precision::full;
    probes.probes.emplace();
    probes.probes->codec = "sh1/moments/convolution";
    probes.probes->samples = 64;
    probes.probes->box = std::array{Vec3{-1, 0.5f, -1}, Vec3{1, 1, 1}};
    probes.textures.storages = std::vector<std::string>{"float16", "ratio8"};
    part.bake.shard = {Shard::By::samples, 1, 2};
    part.bake.samples = 32;
    bake_into("whole", small_job());
    bake_into("plain", plain);
    bake_into("probes", probes);
    bake_into("part", part);
    for (const char* name : {"whole", "plain", "probes"})
        done &= write(folder / "folder", name, bundle_of(made.path() / name));
    return done;
}

/// Makes the folder for one fuzzer and fills it.
bool write_kind(const std::filesystem::path& folder, bool (*write_seeds)(const std::filesystem::path&)) {
    std::filesystem::create_directories(folder);
    return write_seeds(folder);
}

}  // namespace

int main(int count, char** arguments) {
    if (count < 2) {
        std::fprintf(stderr, "usage: make_seeds FOLDER [BAKE...]\n");
        return 2;
    }
    const std::filesystem::path folder = arguments[1];
    for (const char* kind : {"job", "state", "folder"}) std::filesystem::create_directories(folder / kind);
    bool done = write_kind(folder / "hdr", write_hdr_seeds) && write_kind(folder / "exr", write_exr_seeds) &&
                write_kind(folder / "png", write_png_seeds) && write_kind(folder / "jpeg", write_jpeg_seeds) &&
                write_kind(folder / "webp", write_webp_seeds) && write_kind(folder / "gltf", write_gltf_seeds) &&
                write_kind(folder / "manifest", write_manifest_seeds) &&
                write_kind(folder / "coefficients", write_coefficients_seeds) &&
                write_kind(folder / "api", write_api_seeds) && write_session_seeds(folder);
    for (int i = 2; i < count; ++i)
        done &= write(folder / "folder", "given-" + std::to_string(i), bundle_of(arguments[i]));
    return done ? 0 : 1;
}
