// SPDX-License-Identifier: MIT
// Propagation of sh2 with the paper's transport in C++, OpenMP and AVX2, for comparison with the
// OpenCL kernels.
#pragma once

#include <memory>
#include <vector>

#include "basis/basis.hpp"
#include "basis/transport.hpp"

namespace clpv::bench {

/// Returns true if the build has it and this processor has AVX2 and FMA.
bool avx2_supported();

/// Hand-written propagation with the constants of `transport`: vectors of eight cells, slices
/// shared out over all threads.
class PropagateAvx2 {
 public:
  /// `transport`: `sampled` or `exact` for sh2. `grid`: cells along each axis, a multiple of 8.
  /// Throws Error(run_time) for other values.
  PropagateAvx2(const Basis& basis, const Transport& transport, int grid);
  ~PropagateAvx2();

  /// Sets injected light (3 channels x 4 coefficients x grid^3) and the geometry volume (4 x (grid
  /// + 1)^3; null: no occlusion), both in Volume's host order.
  void set(const std::vector<double>& injected, const std::vector<double>* geometry);
  /// Propagates as Propagator does: no occlusion in the first step, transmittances computed once.
  void propagate(int iterations);
  std::vector<float> accumulated() const;  ///< accumulated light, as `injected`

  double flops(int iterations) const;  ///< operations of propagate()
  /// Compulsory traffic of propagate(), counted as for the kernels.
  double bytes(int iterations) const;

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace clpv::bench
