// Prints and complains.
#include "cli/output.h"

#include <cerrno>
#include <cstdio>
#include <system_error>

#include "io/printable.h"

namespace lobelia::cli {
namespace {

void write_out(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) throw OutputFailure(errno);
}

}  // namespace

OutputFailure::OutputFailure(int error)
    : std::runtime_error("standard output: " + std::generic_category().message(error)), code(error) {}

void print_text(std::string_view text) { write_out(printable(text, LineBreaks::kept)); }

void print_line(std::string_view line) { write_out(printable(line) + "\n"); }

void flush_output() {
    if (std::fflush(stdout) != 0) throw OutputFailure(errno);
}

void complain(std::string_view line) {
    std::fputs((printable(line) + "\n").c_str(), stderr);
    std::fflush(stderr);
}

}  // namespace lobelia::cli
