// SPDX-License-Identifier: MIT
// Launches kernels that process every cell of a grid (propagate.cl, transmittance.cl).
#pragma once

#include <cstddef>

#include "device/kernel.hpp"
#include "options/stage_options.hpp"
#include "volume/volume_format.hpp"

namespace clpv {

/// Launch shape of a kernel over all cells of a grid. A work-item processes `lanes` cells along x.
/// A work-group is a row along x, as long as the grid and at most 64 work-items.
class Stencil {
 public:
  /// A grid of `grid` cells along each axis; `format`: of all volumes that the kernel accesses;
  /// `lanes`: 1 or 8.
  Stencil(int grid, const VolumeFormat& format, int lanes);

  /// Literals CLPV_GRID, CLPV_W, CLPV_LOCAL_X and those of the format.
  Literals literals() const;
  /// Launches over all cells of the grid for each of `channels`, which are stacked along z.
  void launch(Kernel& kernel, int channels) const;

 private:
  std::size_t row() const;  ///< work-items

  int grid_;
  VolumeFormat format_;
  int lanes_;
  std::size_t group_;  ///< work-items along x
};

}  // namespace clpv
