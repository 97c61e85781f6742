// SPDX-License-Identifier: MIT
#include "support/log.hpp"

#include <atomic>
#include <memory>
#include <mutex>

#include "support/print.hpp"
#include "support/text.hpp"

namespace clpv {
namespace {

struct Receiver {
  std::mutex mutex;  // not held while it is called
  std::shared_ptr<const LogFunction> function;
  std::atomic<int> least{static_cast<int>(LogLevel::error) + 1};
};

Receiver& receiver() {
  static Receiver& one = *new Receiver;  // never destroyed: threads may log while the process ends
  return one;
}

}  // namespace

void set_log(LogFunction receive, LogLevel least) {
  Receiver& to = receiver();
  const std::lock_guard lock(to.mutex);
  to.least = receive ? static_cast<int>(least) : static_cast<int>(LogLevel::error) + 1;
  to.function = receive ? std::make_shared<const LogFunction>(std::move(receive)) : nullptr;
}

bool is_logged(LogLevel level) {
  return static_cast<int>(level) >= receiver().least;
}

void log_message(LogLevel level, const std::string& message) {
  std::shared_ptr<const LogFunction> function;
  {
    const std::lock_guard lock(receiver().mutex);
    function = receiver().function;
  }
  if (function && is_logged(level)) (*function)(level, printable(message));
}

void log_to_stderr(LogLevel least) {
  set_log([](LogLevel, const std::string& message) { print_message("clpv: " + message + "\n"); },
          least);
}

}  // namespace clpv
