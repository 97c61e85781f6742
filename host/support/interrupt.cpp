// SPDX-License-Identifier: MIT
#include "support/interrupt.hpp"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "support/output_file.hpp"

namespace clpv {
namespace {

constexpr unsigned kPatience = 10;  // [s]: far above a step of work, below what a user waits for

std::atomic<int> pending_signal{0};
std::atomic<const char*> uninterruptible{nullptr};
thread_local const StopRequest* thread_stop = nullptr;
static_assert(std::atomic<const char*>::is_always_lock_free);
static_assert(std::atomic<int>::is_always_lock_free,
              "a signal handler may write only lock-free atomics");

/// Writes text to stderr; async-signal-safe.
void say(const char* text) {
  const auto written = ::write(STDERR_FILENO, text, std::strlen(text));
  static_cast<void>(written);  // nowhere to report a failure
}

/// Ends the process by the signal's default action; async-signal-safe.
void end_by(int signal) {
  remove_unfinished_outputs();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

extern "C" {
static void on_signal(int signal) {
  if (pending_signal.exchange(signal) == signal) return end_by(signal);  // once more
  ::alarm(kPatience);
  if (const char* what = uninterruptible) {
    say("\nclpv: stopping after ");
    say(what);
    say("; once more to stop now\n");
  }
}

/// For loops that never ask.
static void on_alarm(int) {
  if (pending_signal == 0) return;
  if (uninterruptible != nullptr) return static_cast<void>(::alarm(kPatience));
  say("\nclpv: interrupted within a long step, which did not end\n");
  end_by(pending_signal);
}
}

}  // namespace

void catch_interrupts() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    // A shell ignores SIGINT for background processes, nohup SIGHUP; keep that.
    if (std::signal(signal, on_signal) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
  std::signal(SIGALRM, on_alarm);
}

Uninterruptible::Uninterruptible(const char* what) : outer_(uninterruptible.exchange(what)) {}

Uninterruptible::~Uninterruptible() {
  uninterruptible = outer_;
}

StopScope::StopScope(const StopRequest* stop) : outer_(std::exchange(thread_stop, stop)) {}

StopScope::~StopScope() {
  thread_stop = outer_;
}

const StopRequest* current_stop() {
  return thread_stop;
}

bool interrupted() {
  return pending_signal != 0 || (thread_stop != nullptr && *thread_stop);
}

void stop_if_interrupted(const std::string& kept) {
  if (interrupted()) throw Interrupted(kept);
}

void end_as_interrupted() {
  const int pending = pending_signal, signal = pending != 0 ? pending : SIGINT;
  end_by(signal);
  std::abort();  // never reached
}

}  // namespace clpv
