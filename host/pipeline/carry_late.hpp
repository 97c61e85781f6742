// SPDX-License-Identifier: MIT
// Late light, carried from a coarser cascade to the next finer one (kernels/carry_late.cl; docs/method.md, 'Late light').
#pragma once

#include "device/session.hpp"
#include "kernels/shared/grid.h"
#include "pipeline/stencil.hpp"
#include "volume/accumulator.hpp"
#include "volume/volume.hpp"

namespace clpv {

/// Adds a coarser cascade's light to the next finer one's, for volumes of one shape and format.
///
/// Trilinear at the finer cells' centres, zero beyond the coarser grid, and scaled by the cells' areas: it puts the same
/// irradiance on a surface in the finer cascade as in the coarser one.
class LateCarrier {
 public:
  /// `lanes`: 1 or 8, as StencilOptions has it; 0: eight in buffers on a CPU device, which does not find them itself
  /// where every second work-item reads the same cell.
  LateCarrier(Session& session, const VolumeShape& shape, const VolumeFormat& format, int lanes = 0);

  /// `light` of the cells of `coarser` is added to `sum`, of the cells of `finer` [W/sr].
  /// Throws Error(run_time) where the finer cells are not the halves of coarser ones, or leave the coarser grid by more
  /// than half a cell.
  void carry(const Volume& light, const ClpvGrid& coarser, Volume& sum, const ClpvGrid& finer);

 private:
  VolumeShape shape_;
  Stencil stencil_;
  Kernel kernel_;
  Accumulator accumulator_;
};

}  // namespace clpv
