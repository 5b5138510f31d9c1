#include "report/viewer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>

#include "bake/write/bake_files.h"
#include "bake/write/files_together.h"
#include "bake/write/manifest.h"
#include "io/read_file.h"
#include "report/page_template.h"

namespace lobelia {
namespace {

namespace fs = std::filesystem;

/// The embedded files of web/three/, and their places in the folder.
constexpr std::array k_package = {
    std::pair{"three/example/index.html", "index.html"},       std::pair{"three/src/index.js", "lobelia/index.js"},
    std::pair{"three/src/bake.js", "lobelia/bake.js"},         std::pair{"three/src/errors.js", "lobelia/errors.js"},
    std::pair{"three/src/probes.js", "lobelia/probes.js"},     std::pair{"three/src/shader.js", "lobelia/shader.js"},
    std::pair{"three/src/textures.js", "lobelia/textures.js"}, std::pair{"three/src/webgl.js", "lobelia/webgl.js"}};

/// Files of three.js, and their places; the page calls examples/jsm/ "three/addons/".
constexpr std::array k_three = {std::pair{"build/three.module.js", "three/three.module.js"},
                                std::pair{"build/three.core.js", "three/three.core.js"},
                                std::pair{"LICENSE", "three/LICENSE"},
                                std::pair{"examples/jsm/controls/OrbitControls.js", "controls/OrbitControls.js"},
                                std::pair{"examples/jsm/loaders/GLTFLoader.js", "loaders/GLTFLoader.js"},
                                std::pair{"examples/jsm/loaders/EXRLoader.js", "loaders/EXRLoader.js"},
                                std::pair{"examples/jsm/utils/BufferGeometryUtils.js", "utils/BufferGeometryUtils.js"},
                                std::pair{"examples/jsm/utils/SkeletonUtils.js", "utils/SkeletonUtils.js"},
                                std::pair{"examples/jsm/libs/fflate.module.js", "libs/fflate.module.js"},
                                std::pair{"examples/jsm/libs/ktx-parse.module.js", "libs/ktx-parse.module.js"},
                                std::pair{"examples/jsm/libs/zstddec.module.js", "libs/zstddec.module.js"}};

constexpr std::size_t k_most_mebibytes = std::size_t{1} << 14;

Status check_showable(const Manifest& manifest, const std::string& name) {
    if (!manifest.scene) return Error{name + ": holds no copy of its scene, so there is nothing to show"};
    if (manifest.options.codec.empty())
        return Error{name + ": a plain bake has no coefficients; show its --export rgb as a lightMap"};
    if (std::all_of(manifest.pages.begin(), manifest.pages.end(),
                    [](const auto& page) { return page.textures.empty(); }))
        return Error{name + ": has no textures; bake it with a --storage"};
    if (std::none_of(manifest.files.begin(), manifest.files.end(),
                     [](const FileEntry& entry) { return entry.file.starts_with("decode."); }))
        return Error{name + ": has no shader code; bake it again, with a codec for which lobelia shader writes some"};
    return Done{};
}

Status add_copy(FilesTogether& files, const std::string& name, const fs::path& from) {
    const auto bytes = read_text(from, k_most_mebibytes);
    return bytes ? files.add_text(name, *bytes) : bytes.error();
}

Status add_bake(FilesTogether& files, const fs::path& path) {
    const auto text = read_manifest_text(path);
    if (!text) return text.error();
    const auto manifest = manifest_from_json(text->text, text->name);
    if (!manifest) return manifest.error();
    if (Status status = check_showable(*manifest, text->name); !status) return status;
    const auto folder = CommittedFolder::open(bake_folder(path));
    if (!folder) return folder.error();
    const BakeFiles bake(*folder, *manifest);
    if (Status status = files.add_text(std::string("bake/") + k_manifest_name, text->text); !status) return status;
    for (const FileEntry& entry : manifest->files) {
        // The pages themselves are not shown; their textures are.
        const bool is_page = std::any_of(manifest->pages.begin(), manifest->pages.end(),
                                         [&](const PageEntry& page) { return page.file == entry.file; });
        if (is_page) continue;
        const auto checked = bake.checked(entry.file);
        if (!checked) return checked.error();
        if (Status status = add_copy(files, "bake/" + entry.file, *checked); !status) return status;
    }
    return Done{};
}

}  // namespace

Status write_viewer(const fs::path& bake, const fs::path& three, const fs::path& folder, StopFlag stop) {
    auto files = FilesTogether::in(folder, stop);
    if (!files) return files.error();
    if (Status status = add_bake(*files, bake); !status) return status;
    for (const auto& [name, place] : k_package) {
        assert(!report_file(name).empty());
        if (Status status = files->add_text(place, report_file(name)); !status) return status;
    }
    std::error_code code;
    for (const auto& [name, place] : k_three) {
        if (!fs::exists(three / name, code))
            return Error{
                fmt::format("{}: not the folder of three.js: {} is missing there; install it by npm install "
                            "three, and give its folder with --three",
                            three.string(), name)};
        if (Status status = add_copy(*files, place, three / name); !status) return status;
    }
    return files->commit();
}

}  // namespace lobelia
