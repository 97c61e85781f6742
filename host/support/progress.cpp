// SPDX-License-Identifier: MIT
#include "support/progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "support/log.hpp"
#include "support/text.hpp"

namespace clpv {
namespace {

constexpr std::chrono::milliseconds kFirstDraw{1000};  // shorter work needs no bar
constexpr std::chrono::milliseconds kRedraw{100};      // fast enough to read
constexpr std::chrono::seconds kNextLine{10};          // few enough lines for jobs of hours
constexpr int kBarColumns = 30;

ProgressStyle requested_style = ProgressStyle::bar;

int terminal_columns() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

std::string duration(double seconds) {
  const auto whole = std::llround(std::min(seconds, 359999.0));  // at most 99:59:59
  if (whole >= 3600)
    return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

double share_of(std::uint64_t done, std::uint64_t total) {
  return total == 0 ? 1.0 : std::min(1.0, static_cast<double>(done) / static_cast<double>(total));
}

std::string time_left(double share, double elapsed_seconds) {
  return share > 0 ? duration(elapsed_seconds * (1 - share) / share) + " left" : "";
}

/// True if stderr is a terminal that obeys escape codes, and its user wants them
/// (https://no-color.org).
bool takes_escape_codes() {
  const auto value = [](const char* variable) {
    const char* set = std::getenv(variable);
    return std::string_view(set != nullptr ? set : "");
  };
  const std::string_view terminal = value("TERM");
  return ::isatty(STDERR_FILENO) == 1 && !terminal.empty() && terminal != "dumb" &&
         value("NO_COLOR").empty();
}

/// The requested style; `none` if the log is quiet, and lines instead of a bar where escape codes
/// are not taken.
ProgressStyle effective_style() {
  if (!is_logged(LogLevel::info)) return ProgressStyle::none;
  return requested_style == ProgressStyle::bar && !takes_escape_codes() ? ProgressStyle::lines
                                                                        : requested_style;
}

}  // namespace

void set_progress_style(ProgressStyle style) {
  requested_style = style;
}

std::string progress_words(const std::string& title, std::uint64_t done, std::uint64_t total,
                           double elapsed_seconds) {
  const double share = share_of(done, total);
  const std::string left = time_left(share, elapsed_seconds);
  return fmt::format("{}: {:.0f} %{}{}", title, 100 * share, left.empty() ? "" : ", ", left);
}

std::string progress_line(const std::string& title, std::uint64_t done, std::uint64_t total,
                          double elapsed_seconds, int columns) {
  const double share = share_of(done, total);
  const int filled = static_cast<int>(share * kBarColumns);
  const std::string left = time_left(share, elapsed_seconds);
  const std::string bar = std::string(filled, '#') + std::string(kBarColumns - filled, '.');
  const std::string line =
      fmt::format("{} [{}] {:3.0f} % {}", printable(title), bar, 100 * share, left);
  return line.substr(0, static_cast<std::size_t>(std::max(columns, 0)));
}

Progress::Progress(std::string title, std::uint64_t total)
    : title_(std::move(title)),
      total_(total),
      style_(effective_style()),
      started_(Clock::now()),
      next_draw_(started_ + (style_ == ProgressStyle::lines ? kNextLine : kFirstDraw)) {}

Progress::~Progress() {
  if (drawn_) print_over_line("");
}

void Progress::advance(std::uint64_t amount) {
  const std::lock_guard lock(mutex_);
  done_ += amount;
  show();
}

void Progress::reach(std::uint64_t done) {
  const std::lock_guard lock(mutex_);
  done_ = std::max(done_, done);
  show();
}

void Progress::skip(std::uint64_t amount) {
  const std::lock_guard lock(mutex_);
  total_ -= std::min(total_, amount);
}

void Progress::show() {
  const Clock::time_point now = Clock::now();
  if (style_ == ProgressStyle::none || now < next_draw_) return;
  const double elapsed = std::chrono::duration<double>(now - started_).count();
  if (style_ == ProgressStyle::lines) {
    if (done_ >= total_) return;
    log_info("{}", progress_words(title_, done_, total_, elapsed));
    next_draw_ = now + kNextLine;
    return;
  }
  // One column less: some terminals wrap after the last column.
  const std::string line = progress_line(title_, done_, total_, elapsed, terminal_columns() - 1);
  print_over_line(line);
  drawn_ = true;
  next_draw_ = now + kRedraw;
}

}  // namespace clpv
