// SPDX-License-Identifier: MIT
#include "support/interrupt.hpp"

#include <atomic>
#include <csignal>
#include <cstdlib>

namespace clpv {
namespace {

std::atomic<int> came{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal may come in the middle of its use");

extern "C" void remember(int signal) {
  came = signal;
  std::signal(signal, SIG_DFL);  // the next one is not asked
}

}  // namespace

void catch_interrupts() {
  for (const int signal : {SIGINT, SIGTERM}) {
    // Where a shell runs it in the background, SIGINT is ignored, and stays so.
    if (std::signal(signal, remember) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

bool interrupted() {
  return came != 0;
}

void stop_if_interrupted(const std::string& kept) {
  if (interrupted()) throw Interrupted(kept);
}

void end_as_interrupted() {
  const int asked = came, signal = asked != 0 ? asked : SIGINT;
  std::signal(signal, SIG_DFL);
  std::raise(signal);
  std::abort();  // does not come to pass
}

}  // namespace clpv
