// lobelia merge: shards of a bake, merged and finished.
#include "cli/bake_session.h"
#include "cli/options.h"
#include "cli/verbs.h"

namespace lobelia::cli {
namespace {

struct MergeArguments {
    std::vector<std::string> parts;
    std::string out;
    unsigned threads = 0;
};

Status merge_verb(const MergeArguments& arguments) {
    auto session = session_in(arguments.out);
    if (!session) return session.error();
    auto job = read_job(arguments.parts.front());
    if (!job) return job.error();
    job->bake.shard = {};
    job->bake.threads = arguments.threads;
    const StopOnInterrupt stop;
    const auto loaded = load_scene_in(*session, job->scene, stop);
    if (!loaded) return loaded.error();
    const std::vector<std::filesystem::path> parts(arguments.parts.begin(), arguments.parts.end());
    return finish_session(loaded->scene, *job, merge_bake(loaded->scene, *job, parts, *session), *session);
}

}  // namespace

Verb add_merge(CLI::App& app) {
    auto arguments = std::make_shared<MergeArguments>();
    CLI::App* command = app.add_subcommand("merge", "Merge the shards of a bake");
    command
        ->add_option("PART", arguments->parts, "Folders of all shards of one bake, which hold each pass exactly once")
        ->required();
    command->add_option("-o,--out", arguments->out, "Output folder")->required();
    command->add_option("-t,--threads", arguments->threads, "Number of threads, 0: one per processor")
        ->check(CLI::Range(0u, 1024u))
        ->capture_default_str();
    return {command, [arguments]() { return merge_verb(*arguments); }};
}

}  // namespace lobelia::cli
