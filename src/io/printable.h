// Makes text from files and arguments safe to print on a terminal.
#pragma once

#include <string>
#include <string_view>

namespace lobelia {

/// Returns whether all bytes form UTF-8 (RFC 3629): no overlong forms, no surrogates, nothing above U+10FFFF.
[[nodiscard]] bool is_utf8(std::string_view text);

enum class LineBreaks { escaped, kept };

/// Escapes everything that a terminal acts on instead of showing it: control characters (C0, DEL, C1), line and
/// paragraph separators, marks that change the direction of text, and bytes that are not UTF-8. The result is UTF-8;
/// escapes read \n, \x1b or \u202e. Backslashes stay, so escaping twice changes nothing more.
[[nodiscard]] std::string printable(std::string_view text, LineBreaks line_breaks = LineBreaks::escaped);

}  // namespace lobelia
