// SPDX-License-Identifier: MIT
// What this device can do at most, measured in the same run (kernels/ceilings.cl).
#pragma once

#include <vector>

#include "bench/job.hpp"

namespace clpv::bench {

/// A size of data in rotation, and how fast it moves.
struct Bandwidth {
  double working_set;  ///< [bytes]
  double gbps;
};

struct Ceilings {
  double gflops = 0;                  ///< fused multiply-adds, two operations each
  std::vector<Bandwidth> bandwidths;  ///< by rising working set: caches first, memory last
  double launch_ms = 0;               ///< the device's time for a launch that does nothing

  /// Of the smallest measured working set that holds `bytes`, else of the largest.
  double gbps(double bytes) const;
};

/// Rows of suite `ceilings`: ceiling/fma/WIDTH, ceiling/stream/SIZE, ceiling/launch.
std::vector<Case> ceiling_cases(Session& session);

/// From the rows of ceiling_cases(): the best of each, since a ceiling is what has been reached once.
Ceilings ceilings_of(const std::vector<Row>& rows);

/// Tells which ceiling binds the row's work, and what share of it was reached: the longest of the times that its
/// operations, its bytes, or a launch would take at least, over the time it took (median).
void bind(const Ceilings& ceilings, Row& row);

}  // namespace clpv::bench
