// SPDX-License-Identifier: MIT
// Whether a launcher (mpirun, srun) started this process as one of many, and how it then talks to the others.
#pragma once

#include <memory>
#include <optional>

#include "parallel/messages.hpp"

namespace clpv {

/// What a launcher says by the environment, before MPI is asked.
struct Launched {
  int rank = 0;
  std::optional<int> size;  ///< not every launcher tells
};

/// Nothing where no launcher started this process: Open MPI's (OMPI_COMM_WORLD_*), those of PMI (PMI_*) and of PMIx
/// (PMIX_RANK; the size is that of Slurm's step).
std::optional<Launched> launched();

/// Starts MPI, whose module lies beside the program or where the installation puts it. Throws Error(run_time) where it
/// does not.
std::unique_ptr<Messages> start_messages();

}  // namespace clpv
