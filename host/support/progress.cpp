// SPDX-License-Identifier: MIT
#include "support/progress.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace clpv {
namespace {

constexpr std::chrono::milliseconds kFirstDraw{1000};  // shorter work needs no bar
constexpr std::chrono::milliseconds kRedraw{100};      // faster than the eye reads would only cost time
constexpr int kBarColumns = 30;

int terminal_columns() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

std::string duration(double seconds) {
  const auto whole = std::llround(std::min(seconds, 359999.0));  // at most 99:59:59
  if (whole >= 3600) return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

}  // namespace

std::string progress_line(const std::string& title, std::uint64_t done, std::uint64_t total,
                          double elapsed_seconds, int columns) {
  const double share =
      total == 0 ? 1.0 : std::min(1.0, static_cast<double>(done) / static_cast<double>(total));
  const int filled = static_cast<int>(share * kBarColumns);
  const std::string left = share > 0 ? duration(elapsed_seconds * (1 - share) / share) + " left" : "";
  const std::string bar = std::string(filled, '#') + std::string(kBarColumns - filled, '.');
  std::string line = fmt::format("{} [{}] {:3.0f} % {}", title, bar, 100 * share, left);
  return line.substr(0, static_cast<std::size_t>(std::max(columns, 0)));
}

Progress::Progress(std::string title, std::uint64_t total)
    : title_(std::move(title)),
      total_(total),
      enabled_(::isatty(STDERR_FILENO) == 1 && spdlog::should_log(spdlog::level::info)),
      started_(Clock::now()),
      next_draw_(started_ + kFirstDraw) {}

Progress::~Progress() {
  if (drawn_) std::fputs("\r\x1b[K", stderr);
}

void Progress::advance(std::uint64_t amount) {
  const std::lock_guard lock(mutex_);
  done_ += amount;
  if (!enabled_) return;
  const Clock::time_point now = Clock::now();
  if (now < next_draw_) return;
  const double elapsed = std::chrono::duration<double>(now - started_).count();
  // One column short: a full last column makes some terminals start a new line.
  const std::string line = progress_line(title_, done_, total_, elapsed, terminal_columns() - 1);
  std::fprintf(stderr, "\r%s\x1b[K", line.c_str());
  std::fflush(stderr);
  drawn_ = true;
  next_draw_ = now + kRedraw;
}

}  // namespace clpv
