// SPDX-License-Identifier: MIT
// Ctrl-C: long work ends at its next step, says what of it is kept, and leaves things as they should be.
#pragma once

#include <stdexcept>
#include <string>

namespace clpv {

/// Thrown where work was asked to end. what(): what became of it, in the user's words.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// From now on the first SIGINT or SIGTERM only asks work to end; a second one ends the process at once, as they do by
/// themselves.
void catch_interrupts();

/// Whether one came. For loops that do not throw, such as those of other threads.
bool interrupted();

/// Throws Interrupted if one came: "nothing was written", or what `kept` says.
void stop_if_interrupted(const std::string& kept = "nothing was written");

/// Ends the process as the signal that came does by itself, so that whoever started it knows.
[[noreturn]] void end_as_interrupted();

}  // namespace clpv
