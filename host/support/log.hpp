// SPDX-License-Identifier: MIT
// Messages to the receiver of set_log() (clpv/log.hpp); in the program to stderr, since stdout
// carries data only.
#pragma once

#include <fmt/format.h>

#include <string>
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

}  // namespace clpv
