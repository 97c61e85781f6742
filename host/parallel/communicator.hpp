// SPDX-License-Identifier: MIT
// The part of MPI that a team needs. No symbol of this header is defined outside it, so that the module with MPI in it
// (mpi_communicator.cpp), which the program loads at run time, links with nothing of the program.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace clpv {

/// One of several processes (ranks). All ranks call the collective functions in the same order, each from one thread.
class Communicator {
 public:
  virtual ~Communicator() = default;  ///< collective

  virtual int rank() const = 0;
  virtual int size() const = 0;
  virtual int local_rank() const = 0;  ///< among the ranks of this machine
  virtual int local_size() const = 0;
  virtual std::string host() const = 0;

  /// Over all ranks, element by element, in place. Collective, as are those below.
  virtual void sum(double* values, std::size_t count) = 0;
  virtual std::vector<std::string> gather(
      const std::string& mine) = 0;               ///< by rank, at rank 0; elsewhere empty
  virtual void broadcast(std::string& text) = 0;  ///< from rank 0

  /// Ends all ranks with that exit code.
  [[noreturn]] virtual void abort(int code) = 0;
};

/// The one function that the module exports.
using MakeCommunicator = Communicator*();
inline constexpr const char* kMakeCommunicator = "clpv_make_communicator";

}  // namespace clpv
