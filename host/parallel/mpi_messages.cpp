// SPDX-License-Identifier: MIT
// Messages by MPI: a module that is loaded where a launcher started the program, so that it costs nothing elsewhere.
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <mutex>
#include <thread>

#include "parallel/messages.hpp"

namespace clpv {
namespace {

using namespace std::chrono_literals;

// MPI's own waiting takes a whole processor, which other ranks of this machine may need.
constexpr int kTriesBeforeSleep = 200;
constexpr auto kNap = 500us;
// How often rank 0, busy with its own work, looks after what others ask of its counters. Where the network cannot do
// without, they wait for it.
constexpr auto kAttend = 2ms;
// A reduction's count is an int.
constexpr std::size_t kMostAtOnce = std::size_t{1} << 24;

[[noreturn]] void give_up(const char* why) {
  std::fprintf(stderr, "clpv: MPI: %s\n", why);
  MPI_Abort(MPI_COMM_WORLD, 1);
  std::abort();
}

class MpiMessages : public Messages {
 public:
  MpiMessages() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
    if (provided < MPI_THREAD_SERIALIZED) give_up("it was built without threads");
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    MPI_Comm local = MPI_COMM_NULL;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &local);
    MPI_Comm_rank(local, &local_rank_);
    MPI_Comm_size(local, &local_size_);
    MPI_Comm_free(&local);
    share_counters();
    if (rank_ == 0) attendant_ = std::jthread([this](const std::stop_token& stop) { attend(stop); });
  }
  ~MpiMessages() override {
    if (attendant_.joinable()) {
      attendant_.request_stop();
      attendant_.join();
    }
    MPI_Win_unlock_all(window_);
    MPI_Win_free(&window_);
    MPI_Finalize();
  }
  MpiMessages(const MpiMessages&) = delete;
  MpiMessages& operator=(const MpiMessages&) = delete;

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  int local_rank() const override { return local_rank_; }
  int local_size() const override { return local_size_; }

  std::string host() const override {
    char name[MPI_MAX_PROCESSOR_NAME];
    int length = 0;
    const std::lock_guard lock(mutex_);
    MPI_Get_processor_name(name, &length);
    return {name, static_cast<std::size_t>(length)};
  }

  std::int64_t add(int counter, std::int64_t amount) override {
    const std::lock_guard lock(mutex_);
    std::int64_t before = 0;
    MPI_Fetch_and_op(&amount, &before, MPI_INT64_T, 0, counter, MPI_SUM, window_);
    MPI_Win_flush(0, window_);
    return before;
  }

  void barrier(const Idle& idle) override {
    wait([](MPI_Request* request) { MPI_Ibarrier(MPI_COMM_WORLD, request); }, idle);
  }

  void sum(double* values, std::size_t count, const Idle& idle) override {
    for (std::size_t first = 0; first < count; first += kMostAtOnce) {
      const int some = static_cast<int>(std::min(kMostAtOnce, count - first));
      wait(
          [&](MPI_Request* request) {
            MPI_Iallreduce(MPI_IN_PLACE, values + first, some, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD, request);
          },
          idle);
    }
  }

  std::vector<std::string> gather(const std::string& mine, const Idle& idle) override {
    const int length = length_of(mine);
    std::vector<int> lengths(rank_ == 0 ? static_cast<std::size_t>(size_) : 0), starts;
    wait(
        [&](MPI_Request* request) {
          MPI_Igather(&length, 1, MPI_INT, lengths.data(), 1, MPI_INT, 0, MPI_COMM_WORLD, request);
        },
        idle);
    std::size_t total = 0;
    for (const int one : lengths) {
      starts.push_back(static_cast<int>(total));
      total += static_cast<std::size_t>(one);
      if (total > std::numeric_limits<int>::max()) give_up("more than 2 GiB to gather");
    }
    std::string all(total, '\0');
    wait(
        [&](MPI_Request* request) {
          MPI_Igatherv(mine.data(), length, MPI_CHAR, all.data(), lengths.data(), starts.data(), MPI_CHAR, 0,
                       MPI_COMM_WORLD, request);
        },
        idle);
    std::vector<std::string> texts;
    for (std::size_t r = 0; r < lengths.size(); ++r)
      texts.push_back(all.substr(static_cast<std::size_t>(starts[r]), static_cast<std::size_t>(lengths[r])));
    return texts;
  }

  void broadcast(std::string& text, const Idle& idle) override {
    int length = rank_ == 0 ? length_of(text) : 0;
    wait([&](MPI_Request* request) { MPI_Ibcast(&length, 1, MPI_INT, 0, MPI_COMM_WORLD, request); }, idle);
    text.resize(static_cast<std::size_t>(length));
    wait([&](MPI_Request* request) { MPI_Ibcast(text.data(), length, MPI_CHAR, 0, MPI_COMM_WORLD, request); },
         idle);
  }

  [[noreturn]] void abort(int code) override {
    MPI_Abort(MPI_COMM_WORLD, code);
    std::abort();
  }

 private:
  static int length_of(const std::string& text) {
    if (text.size() > std::numeric_limits<int>::max()) give_up("more than 2 GiB in one message");
    return static_cast<int>(text.size());
  }

  void share_counters() {
    const MPI_Aint bytes = rank_ == 0 ? kCounters * static_cast<MPI_Aint>(sizeof(std::int64_t)) : 0;
    std::int64_t* counters = nullptr;
    MPI_Win_allocate(bytes, sizeof(std::int64_t), MPI_INFO_NULL, MPI_COMM_WORLD, &counters, &window_);
    MPI_Win_lock_all(0, window_);
    if (rank_ == 0) std::fill_n(counters, kCounters, 0);
    MPI_Win_sync(window_);
    MPI_Barrier(MPI_COMM_WORLD);
  }

  template <typename Start>
  void wait(const Start& start, const Idle& idle) {
    MPI_Request request = MPI_REQUEST_NULL;
    {
      const std::lock_guard lock(mutex_);
      start(&request);
    }
    for (int tries = 0;; ++tries) {
      int done = 0;
      {
        const std::lock_guard lock(mutex_);
        MPI_Test(&request, &done, MPI_STATUS_IGNORE);
      }
      if (done != 0) return;
      if (tries < kTriesBeforeSleep) continue;
      std::this_thread::sleep_for(kNap);
      if (idle) idle();
    }
  }

  void attend(const std::stop_token& stop) {
    std::mutex asleep;
    std::condition_variable_any stopped;
    std::unique_lock sleeping(asleep);
    while (!stopped.wait_for(sleeping, stop, kAttend, [] { return false; }) && !stop.stop_requested()) {
      const std::lock_guard lock(mutex_);
      int came = 0;
      MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &came, MPI_STATUS_IGNORE);
    }
  }

  int rank_ = 0, size_ = 1, local_rank_ = 0, local_size_ = 1;
  MPI_Win window_ = MPI_WIN_NULL;
  mutable std::mutex mutex_;  // MPI_THREAD_SERIALIZED: windows of some networks can no more
  std::jthread attendant_;    // of rank 0
};

}  // namespace
}  // namespace clpv

extern "C" clpv::Messages* clpv_make_messages() {
  return new clpv::MpiMessages;
}
