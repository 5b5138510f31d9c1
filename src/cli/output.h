// What the command prints: all of it passes through here, so that no control character of a file's names or of an
// argument reaches the terminal, and so that every failure to write is noticed.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <string_view>

namespace lobelia::cli {

/// Why standard output cannot be written to. Thrown by the functions that print there, caught by main.
struct OutputFailure : std::runtime_error {
    explicit OutputFailure(int code);  ///< a value of errno
    int code;
};

/// Prints a text of several lines on standard output. Control characters but line breaks are escaped (io/printable.h):
/// names that the text holds must have been escaped before where they could hold line breaks.
void print_text(std::string_view text);

/// Prints one line on standard output; control characters in it are escaped, line breaks, too.
void print_line(std::string_view line);
template <class... Values>
void print_line(fmt::format_string<Values...> format, Values&&... values) {
    print_line(std::string_view(fmt::format(format, std::forward<Values>(values)...)));
}

/// Writes out what was printed so far.
void flush_output();

/// Prints one line on stderr, escaped likewise; if stderr is closed, the line is lost and nothing else changes.
void complain(std::string_view line);

}  // namespace lobelia::cli
