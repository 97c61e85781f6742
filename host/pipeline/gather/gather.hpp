// SPDX-License-Identifier: MIT
// Stage `gather`: computes the irradiance of every pixel from volumes and the camera's G-buffer
// (kernels/gather/gather.cl).
#pragma once

#include <CL/opencl.hpp>
#include <cstdint>
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
#include "pipeline/raster/surface.hpp"
#include "pipeline/steps/stencil.hpp"
#include "volume/volume.hpp"

namespace clpv {

/// Adds to a program's source what kernels/gather/radiance.h needs. `swept`: basis of swept light.
ProgramSource with_radiance(ProgramSource source, const Basis& swept, const GatherOptions& options);

/// Accumulated light of a frame's cascades, finest first.
struct GatheredLight {
  std::vector<ClpvGrid> grids;
  std::vector<const Volume*> accumulated;  ///< one per grid
  float scale = 1;       ///< factor by which the volumes scale the light (light_scale)
  Buffer occluded = {};  ///< VoxelField::masks() of `grids`, for Gathering::visible
  std::vector<std::uint64_t> keys = {};  ///< the volumes' contents and scale; empty: unknown
};

/// Gathers light of one basis and transport: E(n) = g(n) . c / s^2 (has_faces), for swept light
/// over g(n) . f / pi, f the white furnace in channel 3. c is the volume, sampled trilinearly
/// `gather_offset` cells off the surface. Negative E is clamped to 0.
///
/// The cascade weights depend only on the surface point. Cascade i takes the share m_i = min(1,
/// cells to its boundary / blend_cells) of the weight left by finer ones. The boundary is that of a
/// cube around the eye (ClpvGrid::middle). Light is therefore continuous across cascades and under
/// camera motion. It fades out towards the boundary of the coarsest cascade and is 0 outside.
class Gatherer {
 public:
  Gatherer(Session& session, const Basis& basis, TransportKind transport,
           const GatherOptions& options);

  /// `camera` has format float32; points without a view are allowed.
  /// `irradiance`: float4 per pixel, E of red, green, blue [W/m^2] and 0; all 0 without a surface.
  /// Throws Error(run_time) if counts or shapes do not match, or device memory does not suffice.
  void gather(const Surface& camera, const GatheredLight& light, Buffer& irradiance);

  /// Packs the light for grids(), packed() and add_radiance(), without gathering. Throws as
  /// gather().
  void take(const GatheredLight& light);

  /// Grids and packed volumes (kernels/gather/gather_packed.h) of the last gather() or take() on
  /// the device.
  const Buffer& grids() const { return grids_; }
  cl_uint cascades() const { return cascades_; }

  const Buffer& packed() const { return packed_; }
  const Buffer& occluded() const { return occluded_; }  ///< empty for Gathering::all
  float unit() const { return 1 / scale_; }             ///< [W/sr] of a stored 1

  /// Returns true if volumes are packed. Images are sampled directly, unless gathering selects
  /// single cells, light has a furnace or another stage needs packed volumes.
  bool packs() const {
    return options_.format.layout != Layout::image || sees() || options_.packed || furnace_;
  }

  /// Adds the arguments CLPV_RADIANCE (kernels/gather/radiance.h): the packed volumes of the last
  /// gather().
  void add_radiance(Kernel& kernel) const;

 private:
  bool sees() const { return options_.gather == Gathering::visible; }
  Kernel& gather_kernel(std::size_t cascades, bool points);
  void require_fit(const GatheredLight& light) const;
  void reserve(std::size_t cascades);
  void pack(const GatheredLight& light);

  Session& session_;
  GatherOptions options_;
  int coefficients_;
  bool furnace_;  ///< swept light: channel 3 of the volumes is its white furnace
  int pairs_;
  LookupTable table_;
  ProgramSource source_;
  Stencil stencil_;  ///< stencil of the packing kernel
  std::optional<Kernel> pack_;
  /// By number of cascades, 0 for packed volumes, and whether surfaces are points without a view.
  std::map<std::pair<std::size_t, bool>, Kernel> gather_;
  Buffer packed_, grids_, occluded_;
  std::vector<std::optional<std::uint64_t>> packed_keys_;  ///< keys of the volumes in packed_
  cl_uint cascades_ = 0;
  float scale_ = 1;
};

}  // namespace clpv
