// SPDX-License-Identifier: MIT
// A progress bar on stderr for work that takes over a second.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

namespace clpv {

/// How progress is told, by every Progress made after: a bar where stderr is a terminal; a line of the log now and then, for jobs
/// whose stderr never is one; nothing.
enum class ProgressStyle { bar, lines, none };
void set_progress_style(ProgressStyle style);

/// Counts work done out of a known total. A bar is not drawn during the first second, when stderr is no terminal,
/// or when the log is quiet (set_log_level); it wipes its line at the end, so that what was said before still
/// stands. `advance` and `reach` may be called from several threads.
class Progress {
 public:
  /// `title`: what is being done ("path tracing"); `total`: in the caller's units, 0 is drawn as done.
  Progress(std::string title, std::uint64_t total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void advance(std::uint64_t amount = 1);
  void reach(std::uint64_t done);  ///< in all, where others count too

 private:
  using Clock = std::chrono::steady_clock;
  void show();

  std::string title_;
  std::uint64_t total_, done_ = 0;
  ProgressStyle style_;
  bool drawn_ = false;
  Clock::time_point started_, next_draw_;
  std::mutex mutex_;
};

/// "quality: 118 of 360, 33 %, 2:10 left"
std::string progress_words(const std::string& title, std::uint64_t done, std::uint64_t total,
                           double elapsed_seconds);

/// The line a Progress draws: title, bar, per cent, and the time left at the pace so far. At most `columns`
/// wide.
std::string progress_line(const std::string& title, std::uint64_t done, std::uint64_t total,
                          double elapsed_seconds, int columns);

}  // namespace clpv
