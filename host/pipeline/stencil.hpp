// Launching kernels that serve every cell of a grid (propagate.cl, transmit.cl).
#pragma once

#include <array>
#include <cstddef>

#include "device/kernel.hpp"
#include "volume/volume_format.hpp"

namespace clpv {

/// What shapes such a launch. Work-items lie along x, y, z; along x each serves `lanes` cells.
struct StencilOptions {
  int grid = 32;             ///< cells along each axis
  VolumeFormat format = {};  ///< of all volumes a kernel reaches
  int lanes = 0;             ///< 1 or 8; 0: what suits device and format
  /// Work-group size along x, y; x 0: rows as long as the grid's, at most 64 work-items.
  std::array<std::size_t, 2> local = {0, 1};
};

/// StencilOptions with the device's choices made.
class Stencil {
 public:
  Stencil(const Device& device, const StencilOptions& options);

  int lanes() const { return options_.lanes; }
  const std::array<std::size_t, 2>& local() const { return options_.local; }
  /// CLPV_GRID, CLPV_LANES, CLPV_LOCAL_X, CLPV_LOCAL_Y and the format's.
  Literals literals() const;
  /// Once through the grid for each of `channels`, which are stacked along z.
  void launch(Kernel& kernel, int channels) const;

 private:
  StencilOptions options_;
};

}  // namespace clpv
