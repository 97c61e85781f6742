// SPDX-License-Identifier: MIT
// What each stage is told of a frame's choices, and the one place where that comes from them. Knows no OpenCL, so that
// stages and their CPU references share it.
#pragma once

#include <vector>

#include "basis/blocking.hpp"
#include "basis/rotated_lobe.hpp"
#include "options/choices.hpp"

namespace clpv {

struct RenderOptions;

struct InjectOptions {
  int grid = 32;  ///< cells along each axis
  Blocking blocking = Blocking::one_sided;
  bool unit_flux_lobes = false;  ///< lobes scaled to a flux of pi, as transport `exact` wants them
  LobeOptions lobes = {};        ///< rotated lobes are so at run time, by a table
  TableStorage table = TableStorage::buffer;
  VolumeFormat format = {};  ///< of the volumes injected into
};

/// What shapes a launch that serves every cell of a grid. Work-items lie along x, y, z; along x each serves `lanes` cells.
/// Work-groups are rows as long as the grid's, of at most 64 work-items.
struct StencilOptions {
  int grid = 32;             ///< cells along each axis
  VolumeFormat format = {};  ///< of all volumes a kernel reaches
  int lanes = 0;             ///< 1 or 8; 0: what suits device and format
};

struct PropagateOptions {
  int grid = 32;  ///< cells along each axis
  State state = State::coefficients;
  LobeTime lobe_time = LobeTime::host;
  TableStorage table = TableStorage::buffer;  ///< of lobes rotated in the kernel
  VolumeFormat format = {};                   ///< of all volumes
  int lanes = 0;                              ///< as in StencilOptions

  /// Lobes made in the kernel are those of one cell.
  StencilOptions stencil() const { return {grid, format, lobe_time == LobeTime::kernel ? 1 : lanes}; }
};

/// How the work of a sweep is dealt out; light is the same but for rounding.
enum class SweepForm {
  suited,  ///< to the device
  bins,    ///< a work-item a bin: CPUs
  planes,  ///< a launch a plane: devices of many thousand work-items
};

struct SweepOptions {
  int grid = 32;                   ///< cells along each axis
  std::vector<int> parts;          ///< of each bin (sweep_bins), one a cascade, finest first
  bool blocking = true;            ///< geometry volumes block
  Bounces bounces = Bounces::one;  ///< more need Sweeper::reflect()
  VolumeFormat format = {};        ///< of all volumes; its storage is that of what the sweep keeps for itself
  SweepForm form = SweepForm::suited;
};

struct GatherOptions {
  int grid = 32;  ///< cells along each axis of every cascade
  Gathering gather = Gathering::all;
  double gather_offset = 0.5;  ///< where a surface looks a volume up, in cells along its normal
  double blend_cells = 2;      ///< a cascade hands over to the next coarser one over so many outer cells, > 0
  LobeOptions lobes = {};      ///< b(-n) may come from a table; alpha(-n) is exact always
  TableStorage table = TableStorage::buffer;
  VolumeFormat format = {};  ///< of the cascades' volumes
  bool filtered = true;  ///< images: sampled by the device's filter; else from texels, in single precision
};

/// `unit_flux_lobes`: Transport's.
InjectOptions inject_options(const RenderOptions& options, bool unit_flux_lobes);
PropagateOptions propagate_options(const RenderOptions& options);
SweepOptions sweep_options(const RenderOptions& options);
GatherOptions gather_options(const RenderOptions& options);

}  // namespace clpv
