// SPDX-License-Identifier: MIT
// Options of each stage, derived from RenderOptions. Independent of OpenCL: stages and their CPU
// references share them.
#pragma once

#include <optional>
#include <vector>

#include "basis/bounce.hpp"
#include "basis/rotated_lobe.hpp"
#include "basis/transport.hpp"
#include "kernels/shared/light.h"
#include "options/choices.hpp"

namespace clpv {

struct RenderOptions;
struct Sky;

struct InjectOptions {
  int grid = 32;  ///< cells along each axis
  Blocking blocking = Blocking::one_sided;
  bool unit_flux_lobes = false;  ///< scales lobes to a flux of pi, as transport `exact` requires
  /// Light starts in cells whose centre is in front of its surface; else half a cell off it.
  bool in_front = true;
  LobeOptions lobes = {};  ///< `rotate`: by a table in the kernel
  TableStorage table = TableStorage::buffer;
  VolumeFormat format = {};  ///< format of light and geometry volumes
};

struct PropagateOptions {
  int grid = 32;  ///< cells along each axis
  LobeTime lobe_time = LobeTime::host;
  TableStorage table = TableStorage::buffer;  ///< for lobes rotated in the kernel
  VolumeFormat format = {};                   ///< format of all volumes
};

/// Distribution of a sweep's work. The light is equal up to rounding.
enum class SweepForm {
  suited,  ///< chosen by device type
  bins,    ///< one work-item per bin: CPUs
  groups,  ///< one work-group per bin and channel: devices with thousands of work-items
  planes,  ///< one launch per plane: those of them whose local memory is too small, and media
};
template <>
inline constexpr auto kNames<SweepForm> = name_list("suited", "bins", "groups", "planes");

struct SweepOptions {
  int grid = 32;           ///< cells along each axis
  std::vector<int> parts;  ///< parts of each bin (sweep_bins), per cascade, finest first
  bool blocking = true;    ///< geometry volumes block light
  bool points = false;     ///< links transmit the share of points that see both ends
  /// Limit of the white furnace's radiance: 1 where not all surfaces block light.
  double most_white = kNoLimitOfWhite;
  Bounces bounces = Bounces::one;  ///< more than one needs reflectors in set_surfaces()
  int bounce_sweeps = kSeriesSweeps;
  VolumeFormat format = {};  ///< format of all volumes; internal buffers use its storage
  SweepForm form = SweepForm::suited;
  std::optional<ClpvMedium> medium = {};
  /// Lights the coarsest cascade at its border; used by the constructor alone.
  const Sky* sky = nullptr;
};

struct GatherOptions {
  int grid = 32;  ///< cells along each axis of every cascade
  Gathering gather = Gathering::all;
  /// Distance of the look-up from the surface along its normal [cells].
  double gather_offset = 0.5;
  double blend_cells = 2;  ///< width of the blend to the next coarser cascade [cells], > 0
  LobeOptions lobes = {};  ///< b(-n) may be read from a table; alpha(-n) is always exact
  TableStorage table = TableStorage::buffer;
  VolumeFormat format = {};  ///< format of the cascades' volumes
  bool filtered = true;      ///< images: filtered by the sampler; false: from texels in float
  bool packed = false;       ///< packs images too, for stages `near` and `medium`
};

struct NearOptions {
  GatherOptions gather = {};  ///< how volumes are gathered
  int step = 1;               ///< traces one of step x step pixels: 1, 2, 4 or 8
  int rays = 2;               ///< per traced pixel, a power of two
  bool reflects = false;      ///< surfaces that rays hit also reflect the volumes' light
};

struct MediumOptions {
  GatherOptions gather = {};  ///< how volumes are gathered
  int light_steps = 8;        ///< points of each ray for each light
  int volume_steps = 1;       ///< points of each ray for the volumes
};

/// `unit_flux_lobes`: as in Transport.
InjectOptions inject_options(const RenderOptions& options, bool unit_flux_lobes);
PropagateOptions propagate_options(const RenderOptions& options);
SweepOptions sweep_options(const RenderOptions& options);
/// `medium`: the scene has one.
GatherOptions gather_options(const RenderOptions& options, bool medium = false);
NearOptions near_options(const RenderOptions& options);
MediumOptions medium_options(const RenderOptions& options);

}  // namespace clpv
