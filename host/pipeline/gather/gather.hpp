// SPDX-License-Identifier: MIT
// Stage `gather`: computes the irradiance of every pixel from volumes and the camera's G-buffer (kernels/gather/gather.cl).
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
#include "pipeline/inject/lookup_table.hpp"
#include "pipeline/steps/stencil.hpp"
#include "pipeline/raster/surface.hpp"
#include "volume/volume.hpp"

namespace clpv {

/// Adds to a program's source what kernels/gather/radiance.h needs. `swept`: basis of swept light.
ProgramSource with_radiance(ProgramSource source, const Basis& swept, const GatherOptions& options);

/// Gathers light of one basis and transport: E(n) = g(n) . c / s^2 (has_faces). c is the volume, sampled trilinearly
/// `gather_offset` cells off the surface. Negative E is clamped to 0.
///
/// The cascade weights depend only on the surface point. Cascade i takes the share
/// m_i = min(1, cells to its boundary / blend_cells) of the weight left by finer ones. The boundary is that of a cube
/// around the eye (ClpvGrid::middle). Light is therefore continuous across cascades and under camera motion. It fades
/// out towards the boundary of the coarsest cascade and is 0 outside.
class Gatherer {
 public:
  Gatherer(Session& session, const Basis& basis, TransportKind transport, const GatherOptions& options);

  /// Finest cascade first; `accumulated` has one volume per grid. `camera` has format float32;
  /// points without a view are allowed.
  /// `irradiance`: float4 per pixel, E of red, green, blue [W/m^2] and 0; all 0 without a surface.
  /// `scale`: factor by which the volumes scale the light (light_scale.hpp).
  /// `occluded`: CellVisibility::occluded() of these grids, if GatherOptions::gather is `visible`.
  /// `changed`: volumes that changed since the last call; empty: all.
  /// Throws Error(run_time) if counts or shapes do not match, or device memory does not suffice.
  void gather(const Surface& camera, const std::vector<ClpvGrid>& grids,
              const std::vector<const Volume*>& accumulated, Buffer& irradiance, float scale = 1,
              const Buffer* occluded = nullptr, const std::vector<bool>& changed = {});

  /// Grids and packed volumes (kernels/gather/gather_packed.h) of the last gather() on the device.
  const Buffer& grids() const { return grids_; }
  cl_uint cascades() const { return cascades_; }

  /// Returns true if volumes are packed. Images are sampled directly, unless gathering selects single cells or another stage
  /// needs packed volumes.
  bool packs() const { return options_.format.layout != Layout::image || sees() || options_.packed; }

  /// Adds the arguments CLPV_RADIANCE (kernels/gather/radiance.h): the packed volumes of the last gather(). `scale`, `occluded`: as
  /// for gather().
  void add_radiance(Kernel& kernel, float scale, const Buffer* occluded) const;

 private:
  bool sees() const { return options_.gather == Gathering::visible; }
  Kernel& gather_kernel(std::size_t cascades, bool points);
  void require_fit(const Surface& camera, const std::vector<ClpvGrid>& grids,
                   const std::vector<const Volume*>& volumes) const;
  void reserve(std::size_t cascades);
  void pack(const Volume& volume, std::size_t slot);

  Session& session_;
  GatherOptions options_;
  int coefficients_, pairs_;
  LookupTable table_;
  ProgramSource source_;
  Stencil stencil_;  ///< stencil of the packing kernel
  std::optional<Kernel> pack_;
  /// By number of cascades, 0 for packed volumes, and whether surfaces are points without a view.
  std::map<std::pair<std::size_t, bool>, Kernel> gather_;
  Buffer packed_, grids_;
  cl_uint cascades_ = 0;
};

}  // namespace clpv
