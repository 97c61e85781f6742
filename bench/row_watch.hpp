// SPDX-License-Identifier: MIT
// A limit on how long a row may take to be made ready or to be run once: a kernel that hangs cannot be called back, and
// neither can a driver that waits for it.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace clpv::bench {

class RowWatch {
 public:
  using Clock = std::chrono::steady_clock;

  /// `hung` is called on a thread of its own, with the name of the row, once one takes longer than `limit`; it ends the
  /// process. No limit where that is 0 or less.
  RowWatch(std::chrono::duration<double> limit, std::function<void(const std::string&)> hung);
  ~RowWatch();
  RowWatch(const RowWatch&) = delete;
  RowWatch& operator=(const RowWatch&) = delete;

  /// Calls `work`, which is the row's.
  template <typename Work>
  auto watched(const std::string& row, const Work& work) {
    const Turn turn(*this, row);
    return work();
  }

 private:
  struct Turn {
    Turn(RowWatch& watch, const std::string& row) : watch_(watch) { watch_.begin(row); }
    ~Turn() { watch_.end(); }
    RowWatch& watch_;
  };

  void begin(const std::string& row);
  void end();
  void look_on();

  const Clock::duration limit_;
  const std::function<void(const std::string&)> hung_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Clock::time_point> deadline_;  ///< of the row under way
  std::string row_;
  bool over_ = false;
  std::thread thread_;
};

}  // namespace clpv::bench
