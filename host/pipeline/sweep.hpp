// SPDX-License-Identifier: MIT
// Stage `sweep`: the injected light of all cascades, moved to wherever it goes in one pass a direction (kernels/sweep.cl;
// docs/method.md, 'The sweep').
#pragma once

#include <optional>
#include <vector>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "device/kernel.hpp"
#include "device/session.hpp"
#include "kernels/shared/grid.h"
#include "kernels/shared/sweep.h"
#include "options/stage_options.hpp"
#include "pipeline/bounce.hpp"
#include "pipeline/sweep_volumes.hpp"
#include "scene/sky.hpp"
#include "volume/volume.hpp"

namespace clpv {

static_assert(sizeof(ClpvSweepBin) == CLPV_SIZEOF_SWEEP_BIN &&
              sizeof(ClpvSweepDirection) == CLPV_SIZEOF_SWEEP_DIRECTION &&
              sizeof(ClpvSweepHalo) == CLPV_SIZEOF_SWEEP_SHELL);

/// Sweeps the cascades of a frame, coarsest first. Deterministic to the bit, whatever the number of compute units.
class Sweeper {
 public:
  /// `basis`: of injected light; what comes out is of swept_basis(). `transport`: TransportKind::sweep, which says what blocks.
  Sweeper(Session& session, const Basis& basis, const Transport& transport, const SweepOptions& options);

  /// What blocks in a cascade from now on: (grid + 1)^3 samples.
  void block(std::size_t cascade, const Volume& geometry);

  /// What reflects in a cascade from now on (ReflectorVoxelizer), where SweepOptions::bounces are more than one; after block(),
  /// for what is sent back in all bounces depends on both. `reflectors` must live on.
  void reflect(std::size_t cascade, const Volume& reflectors);

  /// What shines into the coarsest cascade from beyond it, from now on.
  void let_in(const Sky& sky);
  /// So many times as bright: what `injected` holds in place of 1 W/sr.
  void scale_sky(float scale) { sky_scale_ = scale; }

  /// Sweeps `injected` through cascade `cascade` of `grids`, whose coarser one has been swept before, and leaves light of
  /// swept_basis(), as radiance times s^2, in `accumulated`. Throws Error(run_time) for grids that are not nested.
  void sweep(std::size_t cascade, const std::vector<ClpvGrid>& grids, const Volume& injected,
             Volume& accumulated);

  /// The cells of a cascade whose light a sweep of it keeps for the next finer one; those of the finest are none.
  ClpvSweepHalo halo(std::size_t cascade, const std::vector<ClpvGrid>& grids) const;

  /// Whether a launch sweeps all planes, a work-item a bin; else it sweeps one (kernels/sweep.cl).
  bool whole_bins() const;

  /// Whether it reads injected light where it lies, for the bins across z (swept_in_place()).
  bool in_place() const { return in_place_; }

 private:
  struct Pass {  ///< of a cascade
    int parts;
    Buffer directions;  ///< ClpvSweepDirection
    Kernel sweep;
    std::optional<Kernel> let_in;      ///< none: no coarser cascade is beyond
    Buffer halo;                       ///< light for the next finer cascade
    std::optional<Kernel> let_sky_in;  ///< none: nor is a sky
    Buffer sky;                        ///< what comes in along each direction, of cells of 1 m^2
  };
  using Passes = std::vector<Pass>;  ///< one a cascade
  Passes make_passes(const std::vector<int>& parts);
  ProgramSource source_program(const Basis& basis) const;
  void let_nothing_in(const Pass& pass);
  void launch_at_border(Kernel& kernel, const Pass& pass);
  bool let_sky_in(Pass& pass, float cell);
  bool let_in(Passes& passes, std::size_t cascade, const std::vector<ClpvGrid>& grids);
  struct Light {
    const cl::Memory& injected;  ///< as bins_ says, some of the sources are here
    const Buffer& sources;
    const Buffer& sums;  ///< may be the same
  };
  void sweep(Pass& pass, std::size_t cascade, const Light& light, const ClpvSweepHalo& halo, bool lit);
  void sweep(Passes& passes, std::size_t cascade, const Light& light, const std::vector<ClpvGrid>& grids);
  void bounce(std::size_t cascade, const std::vector<ClpvGrid>& grids);
  void bounce_in_all(float cell);
  void collect(std::size_t cascade, Volume& accumulated);
  cl_int before_first(const Pass& pass) const;

  Session& session_;
  SweepOptions options_;
  SweepVolumes volumes_;
  Buffer bins_, light_, live_, border_;
  std::vector<Buffer> through_;  ///< transmittance of the links through each cascade
  bool in_place_;
  Kernel source_, collect_;
  std::optional<Kernel> links_, collect_for_finer_;
  Passes passes_;
  std::optional<Bouncer> bouncer_;  ///< none: one bounce
  Passes
      first_passes_;  ///< of what is to bounce, along 24 directions: of each cascade; for all bounces, of the coarsest
  Buffer first_light_;   ///< that these sweep
  Buffer second_light_;  ///< sent back of it, where that bounces on; none else
  float sky_scale_ = 1;
};

}  // namespace clpv
