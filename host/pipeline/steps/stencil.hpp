// SPDX-License-Identifier: MIT
// Launches kernels that process every cell of a grid (propagate.cl, transmittance.cl).
#pragma once

#include <cstddef>

#include "device/kernel.hpp"
#include "options/stage_options.hpp"
#include "volume/volume_format.hpp"

namespace clpv {

/// StencilOptions with the device's defaults resolved.
class Stencil {
 public:
  Stencil(const Device& device, const StencilOptions& options);

  /// Literals CLPV_GRID, CLPV_W, CLPV_LOCAL_X and those of the format.
  Literals literals() const;
  /// Launches over all cells of the grid for each of `channels`, which are stacked along z.
  void launch(Kernel& kernel, int channels) const;

 private:
  StencilOptions options_;
  std::size_t group_;  ///< work-items along x
};

}  // namespace clpv
