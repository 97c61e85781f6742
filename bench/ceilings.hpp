// SPDX-License-Identifier: MIT
// Roofline ceilings of a device: peak arithmetic, bandwidth and launch time (kernels/ceilings.cl).
// Williams, Waterman and Patterson, 'Roofline: an insightful visual performance model' (CACM 52(4),
// 2009).
#pragma once

#include <vector>

#include "bench/row.hpp"

namespace clpv::bench {

/// Bandwidth of a stream over a working set.
struct Bandwidth {
  double working_set;  ///< [bytes]
  double gbps;
};

struct Ceilings {
  double gflops = 0;                  ///< fused multiply-adds, two operations each
  std::vector<Bandwidth> bandwidths;  ///< by rising working set: caches first, memory last
  double launch_ms = 0;               ///< device time of an empty launch

  /// Bandwidth [GB/s] of the smallest measured working set of at least `bytes`, else of the
  /// largest.
  double gbps(double bytes) const;
};

/// Rows of suite `ceilings`: ceiling/fma/WIDTH, ceiling/stream/SIZE, ceiling/launch.
std::vector<Case> ceiling_cases(Session& session);

/// Ceilings from the rows of ceiling_cases(), each from its fastest sample.
Ceilings ceilings_of(const std::vector<Row>& rows);

/// Sets the row's binding ceiling and the share of it that the row reached:
/// max(flops / gflops, bytes / gbps, launch_ms) / median.
void set_ceiling(const Ceilings& ceilings, Row& row);

}  // namespace clpv::bench
