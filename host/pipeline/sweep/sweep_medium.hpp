// SPDX-License-Identifier: MIT
// The medium of a sweep: where each cascade lies in it, and the light that it scatters in the cells
// of a cascade (kernels/sweep/sweep_medium.cl; docs/method.md, 'Media').
#pragma once

#include <optional>
#include <vector>

#include "device/kernel.hpp"
#include "device/session.hpp"
#include "kernels/shared/grid.h"
#include "kernels/shared/light.h"
#include "pipeline/raster/shadow_maps.hpp"
#include "pipeline/sweep/sweep_volumes.hpp"

namespace clpv {

/// Returns true if there is a medium that does not only absorb.
bool scatters(const std::optional<ClpvMedium>& medium);

class SweepMedium {
 public:
  SweepMedium(Session& session, const SweepVolumes& volumes, const ClpvMedium& medium, int grid,
              std::size_t cascades);

  /// Sets where a cascade lies in the medium.
  void place(std::size_t cascade, const ClpvGrid& grid);

  /// Sets the light that the medium scatters in the cells of `grid` to that of `lights`.
  void scatter_lights(const ClpvGrid& grid, const std::vector<ShadowedLight>& lights);
  /// The same of the lights of the last scatter_lights(), and of light swept in the same cascade.
  void scatter_swept(const Buffer& swept);

  /// Adds the medium to the arguments of a sweep of a cascade. `swept`: with the light of the last
  /// scatter_swept(), not of the lights only.
  void add_to(Kernel& sweep, std::size_t cascade, bool swept) const;

 private:
  Session& session_;
  SweepVolumes volumes_;
  ClpvMedium medium_;
  Kernel scatter_lights_, scatter_swept_;
  std::vector<Buffer> inside_;  ///< cells_in_medium() of each cascade
  Buffer bins_;
  Buffer of_lights_, of_swept_;  ///< source functions: a volume of planes for each channel and bin
};

}  // namespace clpv
