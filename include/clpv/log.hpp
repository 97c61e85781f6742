// SPDX-License-Identifier: MIT
// Messages of the library, such as warnings. The library itself prints nothing.
#pragma once

#include <functional>
#include <string>

namespace clpv {

enum class LogLevel { debug, info, warning, error };

/// Receives one message: plain text without control characters or a newline at its end.
using LogFunction = std::function<void(LogLevel, const std::string&)>;

/// Sets the receiver of all messages of this process of level `least` and higher. An empty
/// function, the initial state, discards all messages. Thread-safe. The receiver is called on any
/// thread that works for the library, also on several at once, and must not throw.
void set_log(LogFunction receive, LogLevel least = LogLevel::info);

}  // namespace clpv
