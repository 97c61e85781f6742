// SPDX-License-Identifier: MIT
#include "support/print.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
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

}  // namespace clpv
