// lobelia view: a folder that shows a bake in a browser.
#include "report/viewer.h"

#include "cli/common.h"
#include "cli/interrupt.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/tools_folder.h"
#include "cli/verbs.h"

namespace lobelia::cli {
namespace {

struct ViewArguments {
    std::string bake, three, out;
};

Status view(const ViewArguments& arguments) {
    if (auto status = check_folder(arguments.out); !status) return status;
    std::filesystem::path three = arguments.three;
    if (three.empty()) {
        const auto tools = tools_folder();
        if (!tools) return tools.error();
        three = *tools / "node_modules" / "three";
    }
    const StopOnInterrupt stop;
    if (auto status = write_viewer(arguments.bake, three, arguments.out, &stop.flag()); !status)
        return ended(status.error(), stop);
    print_line(
        "{}/index.html: show the folder with any static server, such as python3 -m http.server --bind 127.0.0.1 "
        "--directory {}",
        arguments.out, arguments.out);
    return Done{};
}

}  // namespace

Verb add_view(CLI::App& app) {
    auto a = std::make_shared<ViewArguments>();
    CLI::App* command = app.add_subcommand("view", "Write a folder that shows a bake in a browser, by three.js");
    command->add_option("BAKE", a->bake, "The folder that lobelia bake wrote")->required();
    command->add_option(
        "--three", a->three,
        "Folder of three.js's npm package, r180 or newer (default: where npm ci --prefix tools puts it)");
    add_out_option(*command, a->out, "Output folder")->required();
    return {command, [a] { return view(*a); }};
}

}  // namespace lobelia::cli
