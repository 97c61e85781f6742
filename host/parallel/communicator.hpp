// SPDX-License-Identifier: MIT
// Interface to MPI: the operations that clpv uses. Everything in this header is inline or virtual,
// so that the MPI module (mpi_communicator.cpp), which the program loads at run time, links without
// the program.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace clpv {

/// One rank of a communicator. All ranks call the collective functions in the same order, each from
/// one thread.
class Communicator {
 public:
  virtual ~Communicator() = default;  ///< collective

  virtual int rank() const = 0;
  virtual int size() const = 0;
  virtual int local_rank() const = 0;  ///< rank among the processes of this machine
  virtual int local_size() const = 0;
  virtual std::string host() const = 0;  ///< name of this machine

  /// Sums `values` over all ranks, element by element, in place. Collective, like gather() and
  /// broadcast().
  virtual void sum(double* values, std::size_t count) = 0;
  /// Returns every rank's `text`, indexed by rank, at rank 0; empty elsewhere.
  virtual std::vector<std::string> gather(const std::string& text) = 0;
  virtual void broadcast(std::string& text) = 0;  ///< from rank 0

  /// Ends all ranks with exit code `code`.
  [[noreturn]] virtual void abort(int code) = 0;
};

/// The only function that the MPI module exports.
using MakeCommunicator = Communicator*();
inline constexpr const char* kMakeCommunicator = "clpv_make_communicator";

}  // namespace clpv
