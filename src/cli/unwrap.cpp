// lobelia unwrap: gives a glTF scene lightmap UVs, by a script that runs watlas (xatlas) under Node.js.
#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "cli/common.h"
#include "cli/interrupt.h"
#include "cli/options.h"
#include "cli/process.h"
#include "cli/tools_folder.h"
#include "cli/verbs.h"
#include "io/counted.h"
#include "io/json.h"
#include "io/read_file.h"
#include "lobelia/gltf.h"
#include "scene/gltf/gather.h"
#include "scene/lightmap_check.h"

namespace lobelia::cli {
namespace {

struct UnwrapArguments {
    std::string in;
    std::string out;
    std::string layout = "shared";
    std::optional<double> texels_per_metre;
    std::optional<std::uint32_t> size;
    std::uint32_t padding = 4;
    std::size_t uv_set = 1;
    std::uint32_t timeout = 3600;
};

constexpr std::size_t k_most_bytes = std::size_t{1} << 32;

/// Checks that the tools are installed, before anything is read.
Status check_tools(const std::filesystem::path& folder, const std::atomic<bool>& stop) {
    const auto node = run_program({"node", "--version"}, std::chrono::seconds(20), stop);
    if (!node || node->code != 0)
        return Error{
            "lobelia unwrap needs Node.js 18 or newer, and no \"node\" can be run; setup/packages node "
            "installs it; or give the scene lightmap UVs in a modelling program (as TEXCOORD_1)"};
    if (node->out.size() > 1 && std::atoi(node->out.c_str() + 1) < 18)
        return Error{fmt::format("lobelia unwrap needs Node.js 18 or newer; \"node\" is {}",
                                 node->out.substr(0, node->out.find('\n')))};
    std::error_code code;
    if (!std::filesystem::exists(folder / "node_modules" / "watlas", code))
        return Error{fmt::format("the packages that unwrap.mjs uses are missing; run once: npm ci --prefix {}",
                                 folder.string())};
    return Done{};
}

Status check_options(const UnwrapArguments& options) {
    if (!options.out.ends_with(".glb")) return Error{options.out + ": the output's name must end in .glb"};
    if (options.layout == "object" && !options.texels_per_metre)
        return Error{"--layout object requires --texels-per-metre, which sets the size of each object's square"};
    if (options.layout == "object" && options.size)
        return Error{"--layout object cannot be combined with --size: each object has its own"};
    return Done{};
}

/// Sees that the file can be read, that all of it has UVs in the unit square, and that nothing lies on anything else.
Status check_result(const std::filesystem::path& file, const UnwrapArguments& options, const std::atomic<bool>& stop) {
    GltfReadOptions read_options;
    read_options.stop = &stop;
    read_options.uv_set = options.uv_set;
    const auto loaded = read_gltf(file, read_options);
    if (!loaded) return Error{"the unwrapped scene cannot be read: " + loaded.error().message};
    const World world = make_world(loaded->scene);
    const std::size_t objects = loaded->scene.objects.size();
    for (std::size_t i = 0; i < objects; ++i)
        if (world.has_lightmap_uv[i] == 0)
            return Error{fmt::format("object \"{}\" has no lightmap UVs", loaded->scene.objects[i].name)};
    const bool shared = options.layout == "shared";
    for (std::size_t i = 0; i < objects; i = shared ? objects : i + 1) {
        const auto check = check_lightmap(world, i, shared ? objects : i + 1, shared ? 2048 : 256);
        if (check.outside > 0) return Error{fmt::format("{} vertices have lightmap UVs outside [0, 1]", check.outside)};
        // A curved chart may fold over by a sliver where it is flattened.
        if (check.overlapping > check.covered / 1000)
            return Error{fmt::format("charts overlap, first on object \"{}\"",
                                     loaded->scene.objects[world.object[check.first_overlapping]].name)};
    }
    return Done{};
}

/// Reads the scene and all that it refers to, and writes it into `folder` under names that it did not choose: the
/// script opens files without the checks of our reader. Returns the copy.
Result<std::filesystem::path> copy_checked(const UnwrapArguments& options, const std::filesystem::path& folder) {
    const auto gathered = gltf::gather_gltf(options.in, k_most_bytes);
    if (!gathered) return gathered.error();
    for (const auto& [name, bytes] : gathered->files)
        if (auto status = write_file_atomically(folder / name, bytes); !status) return status.error();
    const auto copy = folder / "scene.gltf";
    if (auto status = write_file_atomically(copy, gathered->json); !status) return status.error();
    return copy;
}

/// Files of a run of the script.
struct ScriptFiles {
    std::filesystem::path script, in, out;
};

/// Runs the script; what it printed.
Result<std::string> run_script(const UnwrapArguments& options, const ScriptFiles& files,
                               const std::atomic<bool>& stop) {
    nlohmann::json arguments = {{"layout", options.layout}, {"padding", options.padding}, {"uvSet", options.uv_set}};
    arguments["size"] = options.size ? nlohmann::json(*options.size) : nlohmann::json();
    arguments["texelsPerMetre"] =
        options.texels_per_metre ? nlohmann::json(*options.texels_per_metre) : nlohmann::json();
    auto finished =
        run_program({"node", files.script.string(), files.in.string(), files.out.string(), json_text(arguments)},
                    std::chrono::seconds(options.timeout), stop);
    if (!finished) return Error{options.in + ": " + finished.error().message};
    if (finished->code != 0) {
        const std::string& said = finished->err;
        return Error{fmt::format("{}: {}", options.in, said.substr(0, said.find_last_not_of(" \n") + 1))};
    }
    return std::move(finished->out);
}

/// The script's report of its result as a sentence.
Result<std::string> describe_result(const std::string& printed, const UnwrapArguments& options) {
    return read_json(printed, "unwrap.mjs", [&](const JsonPlace& top) {
        const auto whole = [&](const char* key) { return top.at(key).whole(0, std::uint64_t{1} << 32); };
        std::string text = fmt::format("{}, {}, {:.4g} texels per metre", counted(whole("objects"), "object"),
                                       counted(whole("charts"), "chart"), top.at("density").number());
        if (options.layout == "shared")
            text += fmt::format(" on a page of {0} x {0}: bake with --size {0}x{0}", whole("size"));
        return text;
    });
}

Status unwrap(const UnwrapArguments& options, const std::atomic<bool>& stop) {
    // Look at options, input and tools before the work.
    if (const auto status = check_options(options); !status) return status;
    if (const auto status = check_file(options.out); !status) return status;
    GltfReadOptions reading;
    reading.stop = &stop;
    const auto input = read_gltf(options.in, reading);
    if (!input) return input.error();
    const auto folder = tools_folder();
    if (!folder) return folder.error();
    if (const auto status = check_tools(*folder, stop); !status) return status;

    // Run the script on a copy; check what came out, and only then write it.
    const auto passing = TemporaryFolder::make();
    if (!passing) return passing.error();
    const auto copy = copy_checked(options, passing->path());
    if (!copy) return copy.error();
    const auto file = passing->path() / "unwrapped.glb";
    const auto printed = run_script(options, {*folder / "unwrap.mjs", *copy, file}, stop);
    if (!printed) return printed.error();
    const auto description = describe_result(*printed, options);
    if (!description) return description.error();
    if (const auto status = check_result(file, options, stop); !status)
        return Error{options.in + ": " + status.error().message};
    if (stop) return Error{"stopped", Error::Kind::stopped};
    const auto bytes = read_file(file, k_most_bytes);
    if (!bytes) return bytes.error();
    if (const auto status = write_file_atomically(options.out, *bytes); !status) return status;
    print_line(*description);
    return Done{};
}

Status unwrap_verb(const UnwrapArguments& options) {
    const StopOnInterrupt stop;
    const Status status = unwrap(options, stop.flag());
    if (!status && stop.flag()) StopOnInterrupt::end_program();
    return status;
}

}  // namespace

Verb add_unwrap(CLI::App& app) {
    auto options = std::make_shared<UnwrapArguments>();
    CLI::App* command = app.add_subcommand("unwrap", "Add lightmap UVs to a glTF scene (requires Node.js)");
    command->add_option("SCENE", options->in, "A .glb or .gltf file")->required();
    command->add_option("-o,--out", options->out, "Output file, .glb")->required();
    command
        ->add_option("--layout", options->layout,
                     "shared: all objects in one UV square; object: each has its own, for bakes on several pages")
        ->check(CLI::IsMember({"shared", "object"}))
        ->capture_default_str();
    command
        ->add_option("--texels-per-metre", options->texels_per_metre,
                     "Texels per metre (default: the maximum that fits a page of --size)")
        ->check(number_in(1e-3, 1e5));
    command
        ->add_option("--size", options->size,
                     "Side of the page in texels (default: 1024, or as large as --texels-per-metre requires)")
        ->check(CLI::Range(16u, 16384u));
    command->add_option("--padding", options->padding, "Texels between charts")
        ->check(CLI::Range(0u, 64u))
        ->capture_default_str();
    command->add_option("--uv-set", options->uv_set, "Write TEXCOORD_<this>")
        ->check(CLI::Range(std::size_t{0}, std::size_t{7}))
        ->capture_default_str();
    command->add_option("--timeout", options->timeout, "Time limit in seconds")
        ->check(CLI::Range(1u, 1000000u))
        ->capture_default_str();
    return {command, [options] { return unwrap_verb(*options); }};
}

}  // namespace lobelia::cli
