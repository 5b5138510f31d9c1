// lobelia scene: writes the scenes that the program carries as glTF files.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include "cli/common.h"
#include "cli/options.h"
#include "cli/verbs.h"
#include "io/write_image.h"
#include "lobelia/gltf.h"
#include "scene/embedded.h"

namespace lobelia::cli {
namespace {

struct SceneArguments {
    std::string name;
    std::string out;
    std::string environment;
};

Status scene_verb(const SceneArguments& options) {
    if (!options.out.ends_with(".glb")) return Error{options.out + ": the file's name must end in .glb"};
    // Make everything before the first file is written.
    const auto scene = embedded_scene(options.name);
    if (!scene) return scene.error();
    if (options.environment.empty()) return write_gltf(options.out, *scene);
    const auto glb = encode_glb(*scene);
    if (!glb) return glb.error();
    if (!scene->environment)
        return Error{fmt::format("--environment: the scene {} has none: it is lit by its lamp alone", options.name)};
    const auto exr = encode_exr(*scene->environment);
    if (!exr) return exr.error();
    const FileContent files[] = {{options.out, *glb}, {options.environment, *exr}};
    return write_files_together(files);
}

}  // namespace

Verb add_scene(CLI::App& app) {
    auto options = std::make_shared<SceneArguments>();
    CLI::App* command = app.add_subcommand("scene", "Write an embedded scene as a glTF file");
    command
        ->add_option("NAME", options->name, fmt::format("Embedded scene: {}", fmt::join(embedded_scene_names(), ", ")))
        ->required();
    command->add_option("-o,--out", options->out, "Output file, .glb")->required();
    command->add_option("--environment", options->environment,
                        "Also write its environment, which glTF cannot store, to this file (.exr)");
    return {command, [options] { return scene_verb(*options); }};
}

}  // namespace lobelia::cli
