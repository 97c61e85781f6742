// SPDX-License-Identifier: MIT
// The only ways to stdout and, beside the log, to stderr. Their text may quote scenes, images
// and reports of others, so control characters become '?'.
#pragma once

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace clpv {

/// Prints text to stdout. flush_data() reports failures.
void print_text(std::string_view text);

/// Prints formatted text to stdout.
template <typename... Values>
void print_data(fmt::format_string<Values...> format, Values&&... values) {
  print_text(fmt::format(format, std::forward<Values>(values)...));
}

/// Prints JSON to stdout, with escapes in place of control characters.
void print_json(std::string_view json);

/// Prints text to stderr at once.
void print_message(std::string_view text);

/// Replaces the line of stderr that the cursor is in. For terminals that obey escape codes.
void print_over_line(std::string_view text);

/// Writes out what was printed to stdout. Throws Error(run_time) if some of it could not be
/// written, as on a full disk.
void flush_data();

}  // namespace clpv
