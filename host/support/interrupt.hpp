// SPDX-License-Identifier: MIT
// SIGINT, SIGTERM and SIGHUP: long work ends cleanly at its next step.
#pragma once

#include <stdexcept>
#include <string>

namespace clpv {

/// Thrown when a signal ends work. what() tells the user which results were kept.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Installs the handler: the first of these signals sets interrupted(); the same once more ends
/// the process at once, without its unfinished outputs.
void catch_interrupts();

/// Work that cannot be interrupted, during its lifetime: a signal then logs "stopping after
/// `what`".
class Uninterruptible {
 public:
  explicit Uninterruptible(const char* what);
  ~Uninterruptible();
  Uninterruptible(const Uninterruptible&) = delete;
  Uninterruptible& operator=(const Uninterruptible&) = delete;

 private:
  const char* outer_;
};

/// Returns true after a signal. For loops that must not throw, such as those of other threads.
bool interrupted();

/// Acts as if a signal had come, or forgets one. For hosts that catch signals themselves, such as
/// Python.
void set_interrupted(bool now);

/// Throws Interrupted(kept) after a signal.
void stop_if_interrupted(const std::string& kept = "nothing was written");

/// Ends the process by the pending signal's default action, so that its parent sees the signal.
[[noreturn]] void end_as_interrupted();

}  // namespace clpv
