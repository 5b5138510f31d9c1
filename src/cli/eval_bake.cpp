// The part of lobelia eval that reads whole bakes.
#include "cli/eval_bake.h"

#include <thread>

#include "bake/write/irradiance_files.h"
#include "bake/write/manifest.h"
#include "cli/common.h"
#include "io/read_image.h"

namespace lobelia::cli {

namespace fs = std::filesystem;

Status eval_bake(const EvalBakeOptions& options) {
    // The pages of irradiance have the names of the bake's own.
    std::error_code code;
    if (fs::equivalent(options.folder, bake_folder(fs::absolute(options.bake, code)), code))
        return Error{options.folder + ": this is the bake itself; give another folder"};
    if (auto status = check_folder(options.folder); !status) return status;
    allow_reader_threads(static_cast<int>(std::thread::hardware_concurrency()));
    const auto read = read_bake(options.bake);
    if (!read) return read.error();
    const auto files = write_irradiance(options.folder, *read, {options.evaluator});
    if (!files) return files.error();
    for (const auto& file : *files) print_line(file.string());
    return Done{};
}

}  // namespace lobelia::cli
