// The lobelia command: chooses the verb, prints errors, returns 0, or 2 for bad input.
#include <fmt/core.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <system_error>

#include "cli/common.h"
#include "cli/verbs.h"

namespace {

constexpr int k_bad_input = 2;

constexpr const char* k_short_help =
    R"(lobelia bakes light into lobes: it encodes HDR radiance into small spherical bases
and measures how wrong each choice is.

  lobelia compare sky                      every codec on the embedded sky, as a page
  lobelia compare room.hdr --out report    the same on an environment of yours
  lobelia encode room.hdr --codec sh2/least-squares/convolution -o room.json
  lobelia eval room.json --latlong 64x32 -o irradiance.exr
  lobelia convert room.json --to unity -o unity.json
  lobelia reference room.hdr --latlong 64x32 -o exact.exr
  lobelia list --axes                      bases, encoders and evaluators
  lobelia study irradiance                 how good each irradiance formula is
  lobelia scene cornell -o cornell.glb     a scene to bake
  lobelia unwrap in.glb -o out.glb         lightmap UVs for a scene of yours
  lobelia bake cornell -o bake             lightmaps of a scene, and a page that shows them
  lobelia render bake -o picture.png       the scene, lit by its bake

lobelia -h tells more, lobelia VERB -h all of a verb's options.
)";

/// Parses the command line and does what it says.
int run(CLI::App& app, const std::vector<lobelia::cli::Verb>& verbs, int argc, char** argv) {
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);
        lobelia::cli::complain(fmt::format("lobelia: {}\nRun with -h for the options.", error.what()));
        return k_bad_input;
    }
    for (const auto& verb : verbs) {
        if (!verb.command->parsed()) continue;
        const auto status = verb.action();
        if (!status) lobelia::cli::complain("lobelia: " + status.error().message);
        return status ? 0 : k_bad_input;
    }
    fmt::print("{}", k_short_help);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    // A reader that leaves early (| head) ends the output, not the program with a signal.
    std::signal(SIGPIPE, SIG_IGN);

    CLI::App app{"lobelia bakes light into lobes: encode radiance into spherical bases, measure the error.", "lobelia"};
    app.set_version_flag("--version", std::string("lobelia ") + LOBELIA_VERSION);
    app.require_subcommand(0, 1);
    app.get_formatter()->column_width(36);
    app.footer("lobelia VERB -h tells a verb's options; lobelia alone shows examples.");
    std::vector<lobelia::cli::Verb> verbs;
    for (const auto& add : lobelia::cli::k_verbs) verbs.push_back(add(app));

    try {
        const int code = run(app, verbs, argc, argv);
        if (std::fflush(stdout) != 0) throw std::system_error(errno, std::generic_category(), "standard output");
        return code;
    } catch (const std::system_error& error) {
        // Whoever reads the output has seen enough.
        if (error.code() == std::errc::broken_pipe) return 0;
        lobelia::cli::complain(std::string("lobelia: ") + error.what());
    } catch (const std::bad_alloc&) {
        lobelia::cli::complain("lobelia: not enough memory");
    } catch (const std::exception& error) {
        lobelia::cli::complain(std::string("lobelia: ") + error.what());
    }
    return k_bad_input;
}
