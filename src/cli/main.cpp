// The lobelia command: chooses the verb, prints errors, returns 0, or 2 for bad input.
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <sstream>
#include <system_error>

#include <CLI/CLI.hpp>

#include "cli/output.h"
#include "cli/verbs.h"
#include "lobelia/simd.h"

namespace {

constexpr int k_bad_input = 2;

constexpr const char* k_short_help =
    R"(lobelia bakes light into lobes: it encodes HDR radiance into small spherical bases
and measures how wrong each choice is.

  lobelia compare sky                      all codecs on the embedded sky, as a report
  lobelia compare room.hdr -o report       the same on an environment of yours
  lobelia advise room.hdr --budget 64      the codec and storage for 64 bytes per probe
  lobelia encode room.hdr --codec sh2/least-squares/convolution -o room.json
  lobelia eval room.json --latlong 64x32 -o irradiance.exr
  lobelia convert room.json --to unity -o unity.json
  lobelia reference room.hdr --latlong 64x32 -o exact.exr
  lobelia prefilter room.hdr -o folder     a cube map for reflection probes
  lobelia list --axes                      bases, encoders, evaluators, storages
  lobelia study irradiance                 how good each irradiance formula is
  lobelia study specular                   and each specular formula
  lobelia scene cornell -o cornell.glb     an embedded scene as a glTF file
  lobelia unwrap in.glb -o out.glb         lightmap UVs for a scene of yours
  lobelia bake cornell -o bake             lightmaps of a scene, with a report
  lobelia render bake -o picture.png       the scene, lit by its bake
  lobelia view bake -o page                the same in a browser

lobelia -h lists all verbs, lobelia VERB -h all options of a verb.
)";

std::string simd_names() {
    std::string names;
    for (const std::string& name : lobelia::simd_targets()) names += (names.empty() ? "" : ", ") + name;
    return names;
}

/// Uses the instruction set that the environment variable LOBELIA_SIMD names, if it names one.
lobelia::Status choose_simd_target() {
    const char* name = std::getenv("LOBELIA_SIMD");
    if (name == nullptr || *name == '\0') return lobelia::Done{};
    auto status = lobelia::use_simd_target(name);
    return status ? std::move(status) : lobelia::Error{"LOBELIA_SIMD: " + status.error().message};
}

/// Parses the command line and runs the verb.
int run(CLI::App& app, const std::vector<lobelia::cli::Verb>& verbs, int argc, char** argv) {
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {
            // Help, or the version.
            std::ostringstream text;
            app.exit(error, text, text);
            lobelia::cli::print_text(text.str());
            return 0;
        }
        lobelia::cli::complain(std::string("lobelia: ") + error.what());
        lobelia::cli::complain("Run with -h for the options.");
        return k_bad_input;
    }
    if (const auto status = choose_simd_target(); !status) {
        lobelia::cli::complain("lobelia: " + status.error().message);
        return k_bad_input;
    }
    for (const auto& verb : verbs) {
        if (!verb.command->parsed()) continue;
        const auto status = verb.action();
        if (!status) lobelia::cli::complain("lobelia: " + status.error().message);
        return status ? 0 : k_bad_input;
    }
    lobelia::cli::print_text(k_short_help);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    // A closed pipe (| head) ends the output; it does not kill the program.
    std::signal(SIGPIPE, SIG_IGN);

    CLI::App app{"lobelia bakes light into lobes: encode radiance into spherical bases, measure the error.", "lobelia"};
    app.set_version_flag("--version", std::string("lobelia ") + LOBELIA_VERSION);
    app.require_subcommand(0, 1);
    app.get_formatter()->column_width(36);
    app.footer(
        "lobelia VERB -h lists the options of a verb; lobelia alone shows examples.\n"
        "The environment variable LOBELIA_SIMD sets the instruction set, so that several machines compute the same "
        "bits: " +
        simd_names() + " on this one.");
    std::vector<lobelia::cli::Verb> verbs;
#define LOBELIA_ADD_VERB(name) verbs.push_back(lobelia::cli::add_##name(app));
    LOBELIA_VERBS(LOBELIA_ADD_VERB)
#undef LOBELIA_ADD_VERB

    try {
        const int code = run(app, verbs, argc, argv);
        lobelia::cli::flush_output();
        return code;
    } catch (const lobelia::cli::OutputFailure& failure) {
        // The reader closed the pipe: success.
        if (failure.code == EPIPE) return 0;
        lobelia::cli::complain(std::string("lobelia: ") + failure.what());
    } catch (const std::bad_alloc&) {
        lobelia::cli::complain("lobelia: not enough memory");
    } catch (const std::exception& error) {
        lobelia::cli::complain(std::string("lobelia: an internal error; please report it, with the command: ") +
                               error.what());
    }
    return k_bad_input;
}
