// SPDX-License-Identifier: MIT
// Ranks that share one job: each takes every size()-th item of it. A process without a launcher is a team of one.
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

/// A rank that fails ends all others by abort(): no function below waits for a rank that will not come.
class Ranks {
 public:
  Ranks();  ///< this process alone
  explicit Ranks(std::unique_ptr<Communicator> communicator) : communicator_(std::move(communicator)) {}

  int rank() const { return communicator_->rank(); }
  int size() const { return communicator_->size(); }
  bool alone() const { return size() == 1; }
  bool is_root() const { return rank() == 0; }
  std::string name() const;  ///< "rank 3 on node7"
  /// Processors for this rank: those it is bound to; where it is not bound, its part of the machine's.
  int processors() const;

  /// Whether this rank does that item of a job.
  bool takes(std::size_t item) const {
    return item % static_cast<std::size_t>(size()) == static_cast<std::size_t>(rank());
  }

  /// The device for this rank. Alone, choose_device(choice). Else the ranks of a machine take the devices that `choice` fits
  /// in turn; ranks that share one take equal parts of it, or all of it where it cannot be split. Logs what it is, and warns
  /// where the rank is bound to fewer processors. Throws what choose_devices throws.
  Device device(const std::string& choice) const;

  // Collective: all ranks call them in the same order, each from one thread.
  void sum(std::span<double> values) { communicator_->sum(values.data(), values.size()); }
  /// By rank, at rank 0; elsewhere empty.
  std::vector<std::string> gather(const std::string& mine) { return communicator_->gather(mine); }
  /// What `make` returns at rank 0, on all ranks.
  std::string from_root(const std::function<std::string()>& make);

  /// Ends all ranks with that exit code.
  [[noreturn]] void abort(ExitCode code) {
    communicator_->abort(static_cast<int>(code));
    std::abort();  // never reached
  }

 private:
  std::unique_ptr<Communicator> communicator_;
};

/// A team of one, for work that nobody shares.
Ranks& alone();

/// What the environment says of a launcher: Open MPI's variables (OMPI_COMM_WORLD_*), those of PMI (PMI_*) or of PMIx
/// (PMIX_RANK, with the size of Slurm's step).
struct Launched {
  int rank = 0;
  std::optional<int> size;  ///< not every launcher tells
};
/// Nothing where this process works alone.
std::optional<Launched> launched();

/// Starts MPI, from a module beside the program or where the installation puts it. Throws Error(run_time) without it.
std::unique_ptr<Communicator> start_mpi();

}  // namespace clpv
