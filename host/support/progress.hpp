// SPDX-License-Identifier: MIT
// A progress bar on stderr for work that takes over a second.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

namespace clpv {

/// Counts work done out of a known total. Draws nothing during the first second, when stderr is no terminal,
/// or when the log is quiet (set_log_level); wipes its line at the end, so that what was said before still
/// stands. `advance` may be called from several threads.
class Progress {
 public:
  /// `title`: what is being done ("path tracing"); `total`: in the caller's units, 0 is drawn as done.
  Progress(std::string title, std::uint64_t total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void advance(std::uint64_t amount = 1);

 private:
  using Clock = std::chrono::steady_clock;
  std::string title_;
  std::uint64_t total_, done_ = 0;
  bool enabled_, drawn_ = false;
  Clock::time_point started_, next_draw_;
  std::mutex mutex_;
};

/// The line a Progress draws: title, bar, per cent, and the time left at the pace so far. At most `columns`
/// wide.
std::string progress_line(const std::string& title, std::uint64_t done, std::uint64_t total,
                          double elapsed_seconds, int columns);

}  // namespace clpv
