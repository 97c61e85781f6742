// SPDX-License-Identifier: MIT
// A team of threads in one process, for what is to be found out about teams without MPI.
#pragma once

#include <atomic>
#include <barrier>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "parallel/team.hpp"

namespace clpv::test {

/// What the threads of a team have in common.
struct Meeting {
  explicit Meeting(int size) : size(size), texts(static_cast<std::size_t>(size)), all(size) {}
  int size;
  std::vector<std::string> texts;
  std::vector<double> sums;
  std::barrier<> all;
  std::atomic<std::int64_t> counters[Messages::kCounters] = {};
};

class ThreadMessages : public Messages {
 public:
  ThreadMessages(Meeting& meeting, int rank) : meeting_(meeting), rank_(rank) {}

  int rank() const override { return rank_; }
  int size() const override { return meeting_.size; }
  int local_rank() const override { return rank_; }
  int local_size() const override { return meeting_.size; }
  std::string host() const override { return "threads"; }
  std::int64_t add(int counter, std::int64_t amount) override {
    return meeting_.counters[counter].fetch_add(amount);
  }
  void barrier(const Idle&) override { meeting_.all.arrive_and_wait(); }
  void sum(double* values, std::size_t count, const Idle&) override {
    if (rank_ == 0) meeting_.sums.assign(count, 0);
    for (int turn = 0; turn < meeting_.size; ++turn) {
      meeting_.all.arrive_and_wait();
      for (std::size_t i = 0; turn == rank_ && i < count; ++i) meeting_.sums[i] += values[i];
    }
    meeting_.all.arrive_and_wait();
    std::copy_n(meeting_.sums.begin(), count, values);
    meeting_.all.arrive_and_wait();
  }
  std::vector<std::string> gather(const std::string& mine, const Idle&) override {
    meeting_.texts[static_cast<std::size_t>(rank_)] = mine;
    meeting_.all.arrive_and_wait();
    const std::vector<std::string> all = rank_ == 0 ? meeting_.texts : std::vector<std::string>();
    meeting_.all.arrive_and_wait();
    return all;
  }
  void broadcast(std::string& text, const Idle&) override {
    if (rank_ == 0) meeting_.texts[0] = text;
    meeting_.all.arrive_and_wait();
    text = meeting_.texts[0];
    meeting_.all.arrive_and_wait();
  }
  [[noreturn]] void abort(int code) override { std::_Exit(code); }

 private:
  Meeting& meeting_;
  int rank_;
};

/// Runs `work` as each rank of a team of that size, to its end.
inline void as_team(int size, const std::function<void(Team&)>& work) {
  Meeting meeting(size);
  std::vector<std::jthread> threads;
  for (int rank = 0; rank < size; ++rank) {
    threads.emplace_back([&meeting, &work, rank] {
      Team team(std::make_unique<ThreadMessages>(meeting, rank));
      work(team);
    });
  }
}

}  // namespace clpv::test
