// A bake as a folder: all files are written together, and read again.
#include "bake/write/bake_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "bake/write/bake_fields.h"
#include "bake/write/bake_files.h"
#include "bake/write/lightmap_exports.h"
#include "bake/write/manifest.h"
#include "bake/write/page_files.h"
#include "bake/write/page_textures.h"
#include "bake/write/probe_files.h"
#include "bake/write/probe_textures.h"
#include "bake/write/scene_copy.h"
#include "bake/write/shader_files.h"
#include "core/math/half.h"
#include "io/texture/container.h"
#include "lobelia/bake.h"

namespace lobelia {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_scene_name = "scene.glb";
constexpr const char* k_environment_name = "environment.exr";
constexpr const char* k_probes_name = "probes.json";
constexpr const char* k_probe_coefficients_name = "probes.bin";
constexpr const char* k_probe_visibility_name = "probes.visibility.bin";

/// Finds the largest magnitude on all pages. An error for a value that is not finite.
Result<float> largest_value(const Bake& bake) {
    const auto names = bake.channels().names();
    float largest = 0;
    for (std::size_t p = 0; p < bake.pages.size(); ++p)
        for (std::size_t k = 0; k < bake.pages[p].planes.size(); ++k)
            for (std::size_t i = 0; i < bake.pages[p].size(); ++i) {
                const float value = std::abs(bake.pages[p].planes[k][i]);
                if (!std::isfinite(value))
                    return Error{fmt::format(
                        "page {}, channel {}, x = {}, y = {}: {} cannot be stored; is the light "
                        "too bright for float32?",
                        p, names[k], i % bake.pages[p].width, i / bake.pages[p].width, bake.pages[p].planes[k][i])};
                largest = std::max(largest, value);
            }
    return largest;
}

Status choose_precision(const Bake& bake, Manifest& manifest) {
    const auto largest = largest_value(bake);
    if (!largest) return largest.error();
    const bool dim = *largest > 0 && *largest < k_dim_for_half;
    if (manifest.precision == Precision::full || (!dim && *largest <= k_largest_half)) return Done{};
    manifest.precision = Precision::full;
    manifest.warnings.push_back(
        dim ? fmt::format("no value exceeds {:g}, and half floats end at 6e-8: the pages are written as float",
                          *largest)
            : fmt::format("values up to {:g} exceed the range of half floats ({:g}): the pages are written as float",
                          *largest, k_largest_half));
    return Done{};
}

Status add_pages(FilesTogether& files, const Bake& bake, const PageTextures& textures, Manifest& manifest) {
    const std::string origin = fmt::format("{}, {} frame", manifest.options.codec,
                                           k_frame_names[static_cast<std::size_t>(manifest.options.frame)]);
    manifest.pages.clear();
    for (std::size_t i = 0; i < bake.pages.size(); ++i) {
        PageEntry& baked = manifest.pages.emplace_back(PageEntry{fmt::format("page-{}.exr", i), {}, {}});
        auto status = files.add(baked.file, [&](StagedFile& file) {
            return write_page(file, bake.pages[i], bake.channels(), bake.normals[i], {manifest.precision});
        });
        if (status) status = textures.add(files, bake.pages[i], origin, baked);
        if (!status) return status;
    }
    return Done{};
}

Status add_probes(FilesTogether& files, const Bake& bake, const TextureOptions& textures, Manifest& manifest) {
    manifest.probes.reset();
    if (!bake.probes) return Done{};
    manifest.probes = k_probes_name;
    auto status = files.add(k_probe_coefficients_name,
                            [&](StagedFile& file) { return write_probe_coefficients(file, *bake.probes); });
    const bool has_maps = bake.probes->visibility_side > 0;
    if (status && has_maps)
        status = files.add(k_probe_visibility_name,
                           [&](StagedFile& file) { return write_probe_visibility(file, *bake.probes); });
    if (status)
        status = files.add_text(k_probes_name, to_json_text(*bake.probes, k_probe_coefficients_name,
                                                            has_maps ? k_probe_visibility_name : ""));
    if (status) status = add_probe_textures(files, *bake.probes, textures);
    return status;
}

Status add_scene(FilesTogether& files, const Scene& scene, std::vector<GltfLightmap> lightmaps, Manifest& manifest) {
    // Without a copy the bake is still useful: where glTF cannot hold the scene, warn and go on.
    manifest.scene.reset();
    const auto copy = encode_scene_copy(scene, manifest, std::move(lightmaps));
    if (!copy) {
        manifest.warnings.push_back("the scene was not copied: " + copy.error().message);
    } else {
        manifest.scene = k_scene_name;
        if (auto status = files.add_text(k_scene_name, *copy); !status) return status;
    }
    manifest.environment.reset();
    if (!scene.environment) return Done{};
    manifest.environment = k_environment_name;
    return files.add(k_environment_name, [&](StagedFile& file) { return write_exr(file, *scene.environment); });
}

/// Returns whether a bake may have a file of this name.
bool is_name_of_bake(std::string_view name) {
    for (const char* each :
         {k_scene_name, k_environment_name, k_probes_name, k_probe_coefficients_name, k_probe_visibility_name})
        if (name == each) return true;
    if (is_name_of_shader(name)) return true;
    const auto containers = texture_containers();
    return (name.starts_with("page-") || name.starts_with("probes.")) &&
           (name.ends_with(".exr") || std::any_of(containers.begin(), containers.end(), [&](const auto& container) {
                return name.ends_with("." + std::string(container.name));
            }));
}

/// Removes what the bake in the folder has and the new one does not, and the report, which shows the older one.
void remove_older(FilesTogether& files, const Manifest& manifest) {
    files.remove(k_report_name);
    const auto older = read_manifest(files.folder());
    if (!older) return;
    for (const FileEntry& entry : older->files) {
        const auto same = [&](const FileEntry& e) { return e.file == entry.file; };
        if (is_name_of_bake(entry.file) && std::none_of(manifest.files.begin(), manifest.files.end(), same))
            files.remove(entry.file);
    }
}

Result<Bake> read_files(const fs::path& path, const ManifestText& text) {
    auto manifest = manifest_from_json(text.text, text.name);
    if (!manifest) return manifest.error();
    const auto folder = CommittedFolder::open(bake_folder(path));
    if (!folder) return folder.error();
    Bake bake;
    bake.manifest = *std::move(manifest);
    const BakeFiles files(*folder, bake.manifest);
    for (const auto& baked : bake.manifest.pages) {
        const auto file = files.checked(baked.file);
        if (!file) return file.error();
        auto page = read_page(*file, bake.channels(), bake.manifest.width, bake.manifest.height);
        if (!page) return page.error();
        bake.pages.push_back(std::move(page->page));
        bake.normals.push_back(std::move(page->normals));
    }
    if (bake.manifest.probes) {
        auto probes = read_probes(files, *bake.manifest.probes);
        if (!probes) return probes.error();
        bake.probes = *std::move(probes);
    }
    return bake;
}

}  // namespace

Result<Manifest> write_bake(FilesTogether files, const Bake& bake, const WriteBakeOptions& options) {
    assert(bake.pages.size() == bake.normals.size());
    const auto textures =
        PageTextures::make(bake.manifest.options.codec, options.textures, {bake.manifest.width, bake.manifest.height});
    if (!textures) return textures.error();
    const auto exports = find_lightmap_exports(options.exports);
    if (!exports) return exports.error();
    Manifest manifest = bake.manifest;
    const std::size_t others = files.entries().size();
    auto status = choose_precision(bake, manifest);
    if (status) status = add_pages(files, bake, *textures, manifest);
    if (status) status = add_exports(files, bake, *exports, manifest);
    if (status) status = add_shaders(files, textures->storages(), textures->container(), manifest);
    if (status) status = add_probes(files, bake, options.textures, manifest);
    if (status && options.scene != nullptr) {
        auto lightmaps = lightmaps_in_scene(bake, *exports);
        if (!lightmaps) return lightmaps.error();
        status = add_scene(files, *options.scene, *std::move(lightmaps), manifest);
    }
    manifest.files.assign(files.entries().begin() + static_cast<std::ptrdiff_t>(others), files.entries().end());
    if (status) status = files.add_text(k_manifest_name, to_json_text(manifest));
    if (!status) return status.error();
    remove_older(files, manifest);
    status = files.commit();
    return status ? Result<Manifest>(std::move(manifest)) : status.error();
}

Result<Manifest> write_bake(const fs::path& folder, const Bake& bake, const WriteBakeOptions& options) {
    auto files = FilesTogether::in(folder, options.stop);
    return files ? write_bake(*std::move(files), bake, options) : files.error();
}

Result<Bake> read_bake(const fs::path& path) {
    // A writer may replace the bake meanwhile: what is read belongs together if bake.json is the same after it.
    constexpr int k_attempts = 3;
    for (int i = 0; i < k_attempts; ++i) {
        const auto before = read_manifest_text(path);
        if (!before) return before.error();
        auto bake = read_files(path, *before);
        const auto after = read_manifest_text(path);
        if (after && after->text == before->text) return bake;
    }
    return Error{path.string() + ": changes all the time; read it when its bake is done"};
}

}  // namespace lobelia
