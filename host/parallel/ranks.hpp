// SPDX-License-Identifier: MIT
// Ranks (processes) that share a job: each processes every size()-th item. Without a launcher there
// is one rank.
#pragma once

#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "parallel/communicator.hpp"
#include "support/error.hpp"

namespace clpv {

struct Device;

/// This process among all ranks. A rank that fails ends all others by abort(), so no collective
/// function waits forever.
class Ranks {
 public:
  Ranks();  ///< a single rank, without MPI
  explicit Ranks(std::unique_ptr<Communicator> communicator)
      : communicator_(std::move(communicator)) {}

  int rank() const { return communicator_->rank(); }
  int size() const { return communicator_->size(); }
  bool alone() const { return size() == 1; }
  bool is_root() const { return rank() == 0; }
  std::string name() const;  ///< "rank 3 on node7"
  /// Number of processors for this rank: those it is bound to, else an equal share of the
  /// machine's.
  int processors() const;

  /// Returns true if this rank processes item `item` of a job.
  bool takes(std::size_t item) const {
    return item % static_cast<std::size_t>(size()) == static_cast<std::size_t>(rank());
  }

  /// Returns the device for this rank: choose_device(choice) for a single rank. Else the ranks of a
  /// machine take the devices that match `choice` in turn. Ranks that share a device get equal
  /// sub-devices, or all of it if it cannot be split. Logs the device; warns if the rank is bound
  /// to fewer processors than it has. Throws like choose_devices().
  Device device(const std::string& choice) const;

  // Collective functions: all ranks call them in the same order, each from one thread.

  /// Sums `values` over all ranks, element by element, in place.
  void sum(std::span<double> values) { communicator_->sum(values.data(), values.size()); }
  /// Returns every rank's `text`, indexed by rank, at rank 0; empty elsewhere.
  std::vector<std::string> gather(const std::string& text) { return communicator_->gather(text); }
  /// Calls `make` at rank 0 and returns its result on all ranks.
  std::string from_root(const std::function<std::string()>& make);

  /// Ends all ranks with exit code `code`.
  [[noreturn]] void abort(ExitCode code) {
    communicator_->abort(static_cast<int>(code));
    std::abort();  // never reached
  }

 private:
  std::unique_ptr<Communicator> communicator_;
};

/// The single rank of a job that is not shared.
Ranks& single_rank();

/// Rank and size as a launcher sets them in the environment: Open MPI (OMPI_COMM_WORLD_*), PMI
/// (PMI_*) or PMIx (PMIX_RANK, with the size of Slurm's step).
struct LauncherRank {
  int rank = 0;
  std::optional<int> size;  ///< not every launcher sets it
};
/// Returns nothing if no launcher started this process, or only one.
std::optional<LauncherRank> launcher_rank();

/// Loads the MPI module (clpv_mpi.so, found by RUNPATH) and starts MPI. Throws Error(run_time) if
/// the module is missing.
std::unique_ptr<Communicator> start_mpi();

}  // namespace clpv
