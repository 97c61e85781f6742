// SPDX-License-Identifier: MIT
#include "support/log.hpp"

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <mutex>
#include <utility>

#include "support/error.hpp"
#include "support/text.hpp"

namespace clpv {

namespace {

int failure = 0;  // errno of the first failed write to stdout since flush_data()

void note(bool written) {
  if (!written && failure == 0) failure = errno;
}

}  // namespace

void print_text(std::string_view text) {
  const std::string shown = printable(text);
  note(std::fwrite(shown.data(), 1, shown.size(), stdout) == shown.size());
}

void print_json(std::string_view json) {
  print_text(terminal_json(json));
}

void print_message(std::string_view text) {
  std::fputs(printable(text).c_str(), stderr);  // nowhere to report a failure
}

void print_over_line(std::string_view text) {
  std::fputs(fmt::format("\r{}\x1b[K", printable(text)).c_str(), stderr);
}

void flush_data() {
  note(std::fflush(stdout) == 0);
  if (failure == 0) return;
  const int reason = std::exchange(failure, 0);
  std::clearerr(stdout);
  throw Error(ExitCode::run_time, "stdout: cannot be written: {}", std::strerror(reason));
}

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
