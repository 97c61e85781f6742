// SPDX-License-Identifier: MIT
// Progress of work that takes over 1 s, as a bar on stderr or as log lines.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

namespace clpv {

/// Returns the time since `start` [ms].
inline double ms_since(std::chrono::steady_clock::time_point start) {
  const std::chrono::duration<double, std::milli> elapsed =
      std::chrono::steady_clock::now() - start;
  return elapsed.count();
}

/// bar: on stderr, if it is a terminal, TERM is not `dumb` and NO_COLOR not set; lines: a log line
/// every 10 s, for batch jobs; none.
enum class ProgressStyle { bar, lines, none };
/// Sets the style of every Progress constructed later.
void set_progress_style(ProgressStyle style);

/// Counts work done out of a known total. Draws no bar during the first second. Logs lines instead
/// where a bar cannot be drawn, and nothing if the log is quiet (set_log). The destructor
/// erases the bar. advance(), reach() and skip() are thread safe.
class Progress {
 public:
  /// `title` names the work ("path tracing"); `total` is in the caller's units; a total of 0 counts
  /// as done.
  Progress(std::string title, std::uint64_t total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void advance(std::uint64_t amount = 1);  ///< adds to the work done
  void reach(std::uint64_t done);          ///< sets the work done to at least `done`
  void skip(std::uint64_t amount = 1);     ///< work that took no time, such as cached results

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

/// Returns the log line of a Progress: "quality: 33 %, 2:10 left".
std::string progress_words(const std::string& title, std::uint64_t done, std::uint64_t total,
                           double elapsed_seconds);

/// Returns the bar of a Progress: title, bar, percentage and estimated time left, at most `columns`
/// wide.
std::string progress_line(const std::string& title, std::uint64_t done, std::uint64_t total,
                          double elapsed_seconds, int columns);

}  // namespace clpv
