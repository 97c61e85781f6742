// SPDX-License-Identifier: MIT
// What processes that work together say to each other: the little of MPI that a team stands on. No symbol of this header
// is defined outside it, so that a module with MPI in it (mpi_messages.cpp) needs none of the program's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace clpv {

/// One of several processes. "Of all": to be called by each of them, in the same order, by one thread. While such a call
/// waits, it calls `idle` now and then, which may throw to give up waiting; the process must then end without another word.
class Messages {
 public:
  using Idle = std::function<void()>;
  static constexpr int kCounters = 2;

  virtual ~Messages() = default;  ///< of all: nothing is said after it

  virtual int rank() const = 0;
  virtual int size() const = 0;
  virtual int local_rank() const = 0;  ///< among the processes of this machine
  virtual int local_size() const = 0;
  virtual std::string host() const = 0;

  /// Adds to a counter that all share, at once and for good; its value before. By any thread.
  virtual std::int64_t add(int counter, std::int64_t amount) = 0;

  virtual void barrier(const Idle& idle) = 0;  ///< of all, as are those below
  virtual void sum(double* values, std::size_t count,
                   const Idle& idle) = 0;  ///< of each value, to each process
  /// By rank, at rank 0; elsewhere nothing.
  virtual std::vector<std::string> gather(const std::string& mine, const Idle& idle) = 0;
  virtual void broadcast(std::string& text, const Idle& idle) = 0;  ///< rank 0's, to all

  /// Ends all processes at once, with that exit code.
  [[noreturn]] virtual void abort(int code) = 0;
};

/// What the module has: its one function.
using MakeMessages = Messages*();
inline constexpr const char* kMakeMessages = "clpv_make_messages";

}  // namespace clpv
