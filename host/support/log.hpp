// SPDX-License-Identifier: MIT
// Messages to the receiver of set_log() (clpv/log.hpp); in the program to stderr, since stdout
// carries data only.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

#include "clpv/log.hpp"

namespace clpv {

/// For the program: set_log() with messages to stderr, as "clpv: MESSAGE".
void log_to_stderr(LogLevel least);

/// Returns true if somebody receives messages of this level.
bool is_logged(LogLevel level);

/// Hands a message to the receiver. Control characters become '?': it may quote names of untrusted
/// scenes.
void log_message(LogLevel level, const std::string& message);

template <LogLevel level, typename... Args>
void log_formatted(fmt::format_string<Args...> format, Args&&... args) {
  if (is_logged(level)) log_message(level, fmt::format(format, std::forward<Args>(args)...));
}
template <typename... Args>
void log_debug(fmt::format_string<Args...> format, Args&&... args) {
  log_formatted<LogLevel::debug, Args...>(format, std::forward<Args>(args)...);
}
template <typename... Args>
void log_info(fmt::format_string<Args...> format, Args&&... args) {
  log_formatted<LogLevel::info, Args...>(format, std::forward<Args>(args)...);
}
template <typename... Args>
void log_warning(fmt::format_string<Args...> format, Args&&... args) {
  log_formatted<LogLevel::warning, Args...>(format, std::forward<Args>(args)...);
}

// The only ways to stdout and, beside the log, to stderr. Their text may quote scenes, images
// and reports of others, so control characters become '?'.

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
