// Feeds any bytes to the reader of job.json, and the job to the checks of bake(). See CMakeLists.txt for how to run it.
#include "bake/check_job.h"
#include "bake/session/job_file.h"
#include "check_loaded.h"
#include "lobelia/bake.h"
#include "memory_folder.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lobelia;
    static const MemoryFolder folder;
    folder.write("checkpoint/job.json", bytes_of(data, size));
    const auto job = read_job(folder.path());
    if (!check_result(job)) return 0;
    static_cast<void>(check(*job));

    // Check that the job survives writing and reading again.
    require(static_cast<bool>(save_job(folder.path() / "again", *job)));
    const auto again = read_job(folder.path() / "again");
    require(static_cast<bool>(again));
    require(again->bake.codec == job->bake.codec && again->bake.samples == job->bake.samples);
    require(again->scene.path == job->scene.path && again->textures.storages == job->textures.storages);
    return 0;
}
