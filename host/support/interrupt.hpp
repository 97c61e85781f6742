// SPDX-License-Identifier: MIT
// SIGINT, SIGTERM and SIGHUP: long work ends cleanly at its next step.
#pragma once

#include <atomic>
#include <stdexcept>
#include <string>

namespace clpv {

/// Thrown when a signal ends work. what() tells the user which results were kept.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Installs the handler: the first of these signals sets interrupted(); the same once more, or 10 s
/// of work that does not ask for it, end the process at once, without its unfinished outputs.
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

/// A request to end the work of one call at its next step, made by another thread: for hosts that
/// catch signals themselves, such as Python.
using StopRequest = std::atomic<bool>;

/// Makes `stop` this thread's request, during its lifetime; null: none. A call that starts threads
/// passes current_stop() on to them.
class StopScope {
 public:
  explicit StopScope(const StopRequest* stop);
  ~StopScope();
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;

 private:
  const StopRequest* outer_;
};
const StopRequest* current_stop();

/// Returns true after a signal or this thread's stop request. For loops that must not throw, such
/// as those of other threads.
bool interrupted();

/// Throws Interrupted(kept) if interrupted().
void stop_if_interrupted(const std::string& kept = "nothing was written");

/// Ends the process by the pending signal's default action, so that its parent sees the signal.
[[noreturn]] void end_as_interrupted();

}  // namespace clpv
