// SPDX-License-Identifier: MIT
#include "support/interrupt.hpp"

#include <atomic>
#include <csignal>
#include <cstdlib>

namespace clpv {
namespace {

std::atomic<int> pending_signal{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may write only lock-free atomics");

extern "C" void on_signal(int signal) {
  pending_signal = signal;
  std::signal(signal, SIG_DFL);  // a second signal ends the process at once
}

}  // namespace

void catch_interrupts() {
  for (const int signal : {SIGINT, SIGTERM}) {
    // A shell ignores SIGINT for background processes; keep that.
    if (std::signal(signal, on_signal) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

bool interrupted() {
  return pending_signal != 0;
}

void set_interrupted(bool now) {
  pending_signal = now ? SIGINT : 0;
}

void stop_if_interrupted(const std::string& kept) {
  if (interrupted()) throw Interrupted(kept);
}

void end_as_interrupted() {
  const int pending = pending_signal, signal = pending != 0 ? pending : SIGINT;
  std::signal(signal, SIG_DFL);
  std::raise(signal);
  std::abort();  // never reached
}

}  // namespace clpv
