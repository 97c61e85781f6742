// SPDX-License-Identifier: MIT
// The propagation of sh2 with the paper's transport in C++, OpenMP and AVX2: what the OpenCL kernels are held against.
#pragma once

#include <memory>
#include <vector>

#include "basis/basis.hpp"
#include "basis/transport.hpp"

namespace clpv::bench {

/// Whether it was built for this architecture and this processor has AVX2 and FMA.
bool baseline_supported();

/// Eight cells at a time, rows of a slice after each other, slices over all threads. Not clpv's generated code: the same
/// constants, written by hand.
class PropagateBaseline {
 public:
  /// `transport`: `sampled` or `exact` for sh2, whose flux through a face has this form. `grid`: cells along each axis, a
  /// multiple of 8. Throws Error(run_time) otherwise.
  PropagateBaseline(const Basis& basis, const Transport& transport, int grid);
  ~PropagateBaseline();

  /// Injected light, 3 x 4 planes, and where something blocks the geometry volume: Volume's host order.
  void set(const std::vector<float>& injected, const std::vector<float>* geometry);
  /// As Propagator: the first step does not block, and what blocks is evaluated once.
  void propagate(int iterations);
  std::vector<float> accumulated() const;  ///< host order

  double flops(int iterations) const;  ///< that propagate() executes
  double bytes(int iterations) const;  ///< that must move, counted as for the kernels

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace clpv::bench
