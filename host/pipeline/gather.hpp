// SPDX-License-Identifier: MIT
// Stage `gather`: volumes and the camera's G-buffer in, irradiance of every pixel out (kernels/gather.cl).
#pragma once

#include <CL/opencl.hpp>
#include <map>
#include <optional>
#include <vector>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "device/kernel.hpp"
#include "device/session.hpp"
#include "kernels/shared/grid.h"
#include "options/stage_options.hpp"
#include "pipeline/lookup_table.hpp"
#include "pipeline/stencil.hpp"
#include "pipeline/surface.hpp"
#include "volume/volume.hpp"

namespace clpv {

/// The gathering of one basis and transport. E(n) = g(n) . c / s^2 (has_faces), c the volume
/// sampled trilinearly `gather_offset` cells off the surface, negative E clamped at 0.
///
/// Which cascade lights a surface depends on the surface point alone: cascade i has the share
/// m_i = min(1, cells to its boundary / blend_cells) of what finer ones left; the boundary is that of a cube about the eye
/// (ClpvGrid::middle). So light is continuous across cascades and as the eye moves on, fades out towards the coarsest one's
/// boundary, and is 0 outside.
class Gatherer {
 public:
  Gatherer(Session& session, const Basis& basis, TransportKind transport, const GatherOptions& options);

  /// Finest cascade first; `accumulated` a volume a grid.
  /// `camera` in format float32. `irradiance`: float4 a pixel, E of red, green, blue [W/m^2] and 0; 0 where
  /// there is no surface. `scale`: the volumes hold so many times the light (light_scale.hpp). Throws Error(run_time) where counts or shapes do not fit, or the device's memory
  /// does not suffice.
  /// `occluded`: CellVisibility::occluded() of these grids, where GatherOptions::gather is `visible`.
  /// `changed`: which volumes are not as they were in the last call; none told: all.
  void gather(const Surface& camera, const std::vector<ClpvGrid>& grids,
              const std::vector<const Volume*>& accumulated, Buffer& irradiance, float scale = 1,
              const Buffer* occluded = nullptr, const std::vector<bool>& changed = {});

 private:
  bool sees() const { return options_.gather == Gathering::visible; }
  /// Images are sampled as they are, unless cells are chosen one by one.
  bool packs() const { return options_.format.layout != Layout::image || sees(); }
  Kernel& gather_kernel(std::size_t cascades);
  void require_fit(const Surface& camera, const std::vector<ClpvGrid>& grids,
                   const std::vector<const Volume*>& volumes) const;
  void reserve(std::size_t cascades);
  void pack(const Volume& volume, std::size_t slot);

  Session& session_;
  GatherOptions options_;
  int coefficients_, pairs_;
  LookupTable table_;
  ProgramSource source_;
  Stencil stencil_;  ///< of packing
  std::optional<Kernel> pack_;
  std::map<std::size_t, Kernel>
      gather_;  ///< by number of cascades, of which only volumes not packed take note
  Buffer packed_, grids_;
};

}  // namespace clpv
