// SPDX-License-Identifier: MIT
#include "bench/row_watch.hpp"

namespace clpv::bench {

RowWatch::RowWatch(std::chrono::duration<double> limit, std::function<void(const std::string&)> hung)
    : limit_(std::chrono::duration_cast<Clock::duration>(limit)), hung_(std::move(hung)) {
  if (limit_.count() > 0) thread_ = std::thread([this] { look_on(); });
}

RowWatch::~RowWatch() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  changed_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void RowWatch::begin(const std::string& row) {
  const std::lock_guard lock(mutex_);
  row_ = row;
  deadline_ = Clock::now() + limit_;
  changed_.notify_one();
}

void RowWatch::end() {
  const std::lock_guard lock(mutex_);  // waits for ever once hung_ is at work: the process ends there
  deadline_.reset();
  changed_.notify_one();
}

void RowWatch::look_on() {
  std::unique_lock lock(mutex_);
  while (!over_) {
    if (!deadline_) {
      changed_.wait(lock);
    } else if (const Clock::time_point deadline = *deadline_; Clock::now() < deadline) {
      changed_.wait_until(lock, deadline);
    } else {
      hung_(row_);
      deadline_.reset();
    }
  }
}

}  // namespace clpv::bench
