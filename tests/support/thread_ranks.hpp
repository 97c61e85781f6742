// SPDX-License-Identifier: MIT
// Ranks as threads of one process, to test without MPI.
#pragma once

#include <algorithm>
#include <barrier>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "parallel/ranks.hpp"

namespace clpv::test {

/// State that the threads share.
struct Meeting {
  explicit Meeting(int size) : size(size), texts(static_cast<std::size_t>(size)), all(size) {}
  int size;
  std::vector<std::string> texts;
  std::vector<double> sums;
  std::barrier<> all;
};

class ThreadCommunicator : public Communicator {
 public:
  ThreadCommunicator(Meeting& meeting, int rank) : meeting_(meeting), rank_(rank) {}

  int rank() const override { return rank_; }
  int size() const override { return meeting_.size; }
  int local_rank() const override { return rank_; }
  int local_size() const override { return meeting_.size; }
  std::string host() const override { return "threads"; }
  void sum(double* values, std::size_t count) override {
    if (rank_ == 0) meeting_.sums.assign(count, 0);
    for (int turn = 0; turn < meeting_.size; ++turn) {
      barrier();
      for (std::size_t i = 0; turn == rank_ && i < count; ++i) meeting_.sums[i] += values[i];
    }
    barrier();
    std::copy_n(meeting_.sums.begin(), count, values);
    barrier();
  }
  std::vector<std::string> gather(const std::string& mine) override {
    meeting_.texts[static_cast<std::size_t>(rank_)] = mine;
    barrier();
    const std::vector<std::string> all = rank_ == 0 ? meeting_.texts : std::vector<std::string>();
    barrier();
    return all;
  }
  void broadcast(std::string& text) override {
    if (rank_ == 0) meeting_.texts[0] = text;
    barrier();
    text = meeting_.texts[0];
    barrier();
  }
  [[noreturn]] void abort(int code) override { std::_Exit(code); }

 private:
  void barrier() { meeting_.all.arrive_and_wait(); }

  Meeting& meeting_;
  int rank_;
};

/// Runs `work` on `size` ranks, one thread each, and waits for all of them.
inline void run_ranks(int size, const std::function<void(Ranks&)>& work) {
  Meeting meeting(size);
  std::vector<std::jthread> threads;
  for (int rank = 0; rank < size; ++rank) {
    threads.emplace_back([&meeting, &work, rank] {
      Ranks ranks(std::make_unique<ThreadCommunicator>(meeting, rank));
      work(ranks);
    });
  }
}

}  // namespace clpv::test
