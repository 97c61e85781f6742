// SPDX-License-Identifier: MIT
// Processes that do one job together, each with its share of it; one process alone is a team too, so that work is written
// once.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "parallel/messages.hpp"
#include "support/error.hpp"
#include "support/progress.hpp"

namespace clpv {

struct Failure;

/// What all ranks throw when some of them failed, in place of what these threw; it is rank 0 that tells it.
class TeamFailure : public Error {
 public:
  using Error::Error;
};

/// A job of many items, any of which any rank can do.
struct SharedWork {
  std::size_t items = 0;  ///< from 0 on, in the order they are handed out in: longest first
  std::function<void(std::size_t)> work = {};  ///< on one of them; tells of its progress by Team::done
  std::function<std::string()> place = {};  ///< what this rank is at, for those who read that it failed there
  Progress* progress = nullptr;             ///< shows, at rank 0, what all have done
  std::function<std::string()> kept = {};   ///< what an interrupt leaves, in the user's words
};

/// Functions are to be called by all ranks, in the same order and by one thread, where nothing else is said. While they wait
/// for others they throw Interrupted where a user interrupts; anything else that leaves a rank between two of them unheard
/// must end all (abort()).
class Team {
 public:
  Team();  ///< of one: this process
  explicit Team(std::unique_ptr<Messages> messages);

  int rank() const { return messages_->rank(); }
  int size() const { return messages_->size(); }
  int local_rank() const { return messages_->local_rank(); }
  int local_size() const { return messages_->local_size(); }
  bool alone() const { return size() == 1; }
  /// Whether this is rank 0, which writes what is written once, and tells what is told once.
  bool leads() const { return rank() == 0; }
  /// "rank 3 on node7"
  std::string name() const;
  /// Processors that this rank may take: those it is bound to, or where it is bound to none its part of its machine's.
  int processors() const;
  int bound_processors() const;  ///< all of the machine's where it is bound to none

  /// Does `work` on each rank. Where it throws on some, all throw: alone, what was thrown; else TeamFailure with what they
  /// said, and which of them where they are not of one voice.
  void agree(const std::function<void()>& work);

  /// Begins to hand out `items`, from 0 on, one by one.
  void begin(std::size_t items);
  /// The next item that nobody has taken; nothing where all are. By any rank and thread.
  std::optional<std::size_t> take();
  /// Tells that so much more is done. How much all have done. By any rank and thread.
  std::uint64_t done(std::uint64_t amount);

  /// Does each item on whichever rank is free. A rank whose work throws says where it was and takes no more; the others go
  /// on, and once all items are taken all throw TeamFailure. Alone, what was thrown.
  void share(const SharedWork& job);

  void barrier();
  void sum(std::span<double> values);  ///< of each over all ranks, in place
  /// By rank, at rank 0; elsewhere nothing.
  std::vector<std::string> gather(const std::string& mine);
  /// What rank 0 makes. What that throws, all throw, as of agree().
  std::string from_first(const std::function<std::string()>& make);

  /// Ends all ranks at once, with that exit code.
  [[noreturn]] void abort(ExitCode code);

 private:
  Messages::Idle idle();
  void settle(const std::optional<Failure>& mine, bool told);

  std::unique_ptr<Messages> messages_;
  std::size_t items_ = 0;
  const SharedWork* job_ = nullptr;  ///< under way
};

/// Of one: for work that nobody shares.
Team& alone();

}  // namespace clpv
