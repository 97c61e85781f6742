// SPDX-License-Identifier: MIT
// The sweep of one cascade of bins24 from a dark border in C++, OpenMP and AVX2: what the OpenCL kernels are held against.
#pragma once

#include <memory>
#include <vector>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "bench/baseline/avx2.hpp"

namespace clpv::bench {

/// Not clpv's generated code: the same constants, written by hand, with nothing of a border but zeros. Volumes stay as they come,
/// slice by slice, but for planes across x, which are turned eight at a time. Bins24's coefficients are swept as the bins' means that
/// they are. Where nothing blocks, a thread sweeps a bin and channel, whose directions' planes stay in the first-level cache, with three
/// multiply-adds for a direction's four taps. Else it sweeps four bins together, all channels, and finds out on the way what the nine ways
/// across their planes let through.
class SweepBaseline {
 public:
  /// `basis`: bins24, whose coefficients are the bins' means. `transport`: TransportKind::sweep, blocked by areas. `grid`: cells
  /// along each axis, a multiple of 8. `parts`: of a bin (sweep_bins). Throws Error(run_time) otherwise.
  SweepBaseline(const Basis& basis, const Transport& transport, int grid, int parts);
  ~SweepBaseline();

  /// Injected light, 3 x 24 planes, and where something blocks the geometry volume, 3 planes of areas: Volume's host order.
  void set(const std::vector<float>& injected, const std::vector<float>* geometry);
  /// As Sweeper's block(), where something blocks, and sweep(): from injected light and areas to nine harmonics.
  void sweep();
  std::vector<float> accumulated() const;  ///< 3 x 9 planes, host order

  double flops() const;        ///< that sweep() executes
  double bytes() const;        ///< that must move, counted as for the kernels
  double working_set() const;  ///< [bytes]

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace clpv::bench
