// SPDX-License-Identifier: MIT
#include "parallel/team.hpp"

#include <fmt/ranges.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <map>
#include <thread>

#include "parallel/failure.hpp"
#include "support/interrupt.hpp"
#include "support/log.hpp"

namespace clpv {
namespace {

enum Counter : int { kTaken, kDone };

constexpr std::size_t kMostVoices = 4;  // of failures that differ from rank to rank

/// Nobody to talk to.
class Alone : public Messages {
 public:
  int rank() const override { return 0; }
  int size() const override { return 1; }
  int local_rank() const override { return 0; }
  int local_size() const override { return 1; }
  std::string host() const override { return "this machine"; }
  std::int64_t add(int counter, std::int64_t amount) override { return counters_[counter].fetch_add(amount); }
  void barrier(const Idle&) override {}
  void sum(double*, std::size_t, const Idle&) override {}
  std::vector<std::string> gather(const std::string& mine, const Idle&) override { return {mine}; }
  void broadcast(std::string&, const Idle&) override {}
  [[noreturn]] void abort(int code) override { std::_Exit(code); }

 private:
  std::atomic<std::int64_t> counters_[kCounters] = {};
};

/// As one text, and back: the code's digit, then the words.
std::string packed(const std::optional<Failure>& failure) {
  return failure ? fmt::format("{}{}", static_cast<int>(failure->code), failure->words) : "";
}

Failure unpacked(const std::string& text) {
  return {static_cast<ExitCode>(text.at(0) - '0'), text.substr(1)};
}

/// What ranks said, as one: the code of the first that failed; the words of all, where they say the same, else whose they are.
std::string of_one_voice(const std::vector<std::string>& said, const std::vector<std::string>& names) {
  std::map<std::string, std::vector<std::string>> voices;
  std::string first;
  std::size_t failed = 0;
  for (std::size_t r = 0; r < said.size(); ++r) {
    if (said[r].empty()) continue;
    if (failed++ == 0) first = said[r];
    voices[unpacked(said[r]).words].push_back(names[r]);
  }
  if (failed == 0 || (voices.size() == 1 && failed == said.size())) return first;
  std::vector<std::string> lines;
  for (const auto& [words, who] : voices) {
    if (lines.size() == kMostVoices) {
      lines.push_back(fmt::format("and {} other failures", voices.size() - kMostVoices));
      break;
    }
    lines.push_back(fmt::format("{}{}: {}", who.front(),
                                who.size() > 1 ? fmt::format(" and {} more", who.size() - 1) : "", words));
  }
  return packed(Failure{unpacked(first).code, fmt::format("{}", fmt::join(lines, "\n"))});
}

}  // namespace

Team::Team() : Team(std::make_unique<Alone>()) {}
Team::Team(std::unique_ptr<Messages> messages) : messages_(std::move(messages)) {}

std::string Team::name() const {
  return fmt::format("rank {} on {}", rank(), messages_->host());
}

int Team::bound_processors() const {
  cpu_set_t bound;
  if (::sched_getaffinity(0, sizeof bound, &bound) == 0) return CPU_COUNT(&bound);
  return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

int Team::processors() const {
  const int bound = bound_processors(), there = static_cast<int>(::sysconf(_SC_NPROCESSORS_ONLN));
  return bound < there ? bound : std::max(1, there / local_size());
}

/// While this rank waits: the user may interrupt, and the others' work shows.
Messages::Idle Team::idle() {
  return [this] {
    if (interrupted())
      throw Interrupted(job_ != nullptr && job_->kept ? job_->kept() : "nothing was written");
    if (leads() && job_ != nullptr) done(0);
  };
}

/// What agree() and share() end with. `told`: those that failed said so themselves.
void Team::settle(const std::optional<Failure>& mine, bool told) {
  const std::vector<std::string> said = gather(packed(mine)), names = gather(mine ? name() : "");
  std::string all;
  if (leads()) {
    all = of_one_voice(said, names);
    const auto failed = said.size() - static_cast<std::size_t>(std::ranges::count(said, ""));
    if (told && failed > 0) {
      all = packed(Failure{
          unpacked(all).code,
          fmt::format("{} of {} ranks failed; the same command does what is left", failed, said.size())});
    }
  }
  messages_->broadcast(all, idle());
  job_ = nullptr;
  if (all.empty()) return;
  const Failure failure = unpacked(all);
  throw TeamFailure(failure.code, failure.words);
}

namespace {

/// What all ranks come upon alike is rank 0's to tell.
class Hushed {
 public:
  explicit Hushed(bool hush) : before_(spdlog::get_level()) {
    if (hush && before_ == spdlog::level::warn) spdlog::set_level(spdlog::level::err);
  }
  ~Hushed() { spdlog::set_level(before_); }
  Hushed(const Hushed&) = delete;
  Hushed& operator=(const Hushed&) = delete;

 private:
  spdlog::level::level_enum before_;
};

}  // namespace

void Team::agree(const std::function<void()>& work) {
  if (alone()) return work();
  std::optional<Failure> failure;
  try {
    const Hushed hushed(!leads());
    work();
  } catch (const Interrupted&) {
    throw;
  } catch (...) {
    failure = current_failure();
  }
  settle(failure, false);
}

void Team::begin(std::size_t items) {
  barrier();  // nobody is at the job before
  if (leads()) {
    for (const int counter : {kTaken, kDone}) messages_->add(counter, -messages_->add(counter, 0));
  }
  items_ = items;
  barrier();
}

std::optional<std::size_t> Team::take() {
  const auto item = static_cast<std::size_t>(messages_->add(kTaken, 1));
  return item < items_ ? std::optional(item) : std::nullopt;
}

std::uint64_t Team::done(std::uint64_t amount) {
  const auto all =
      static_cast<std::uint64_t>(messages_->add(kDone, static_cast<std::int64_t>(amount))) + amount;
  if (leads() && job_ != nullptr && job_->progress != nullptr) job_->progress->reach(all);
  return all;
}

void Team::share(const SharedWork& job) {
  begin(job.items);
  job_ = &job;
  std::optional<Failure> failure;
  try {
    while (const auto item = take()) job.work(*item);
  } catch (const Interrupted&) {
    throw;
  } catch (...) {
    if (alone()) {
      job_ = nullptr;
      throw;
    }
    failure = current_failure();
    spdlog::error("{}: {}: {}", name(), job.place(), failure->words);
  }
  settle(failure, true);
}

void Team::barrier() {
  messages_->barrier(idle());
}

void Team::sum(std::span<double> values) {
  messages_->sum(values.data(), values.size(), idle());
}

std::vector<std::string> Team::gather(const std::string& mine) {
  return messages_->gather(mine, idle());
}

std::string Team::from_first(const std::function<std::string()>& make) {
  std::string text;
  agree([&] {
    if (leads()) text = make();
  });
  messages_->broadcast(text, idle());
  return text;
}

void Team::abort(ExitCode code) {
  messages_->abort(static_cast<int>(code));
  std::abort();  // does not come to pass
}

Team& alone() {
  static Team team;
  return team;
}

}  // namespace clpv
