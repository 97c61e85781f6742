// SPDX-License-Identifier: MIT
// Work on several threads, whose exceptions reach the caller.
#pragma once

#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "support/error.hpp"

namespace clpv::pathtracer {

/// Calls work(failed) on `count` threads, this one included, and waits for all. After an exception
/// `failed` is true, at which the others should end; rethrows the first one. Throws Error(run_time)
/// if the system has not so many threads.
template <typename Work>
void on_threads(int count, const Work& work) {
  std::atomic<bool> failed{false};
  std::exception_ptr failure;
  std::mutex mutex;
  const auto run = [&] {
    try {
      work(failed);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failed.exchange(true)) failure = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> others;
    try {
      for (int t = 1; t < count; ++t) others.emplace_back(run);
    } catch (const std::system_error& error) {
      failed = true;
      throw Error(ExitCode::run_time, "threads: found {}, of which the system started {}: {}",
                  count, others.size() + 1, error.code().message());
    }
    run();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace clpv::pathtracer
