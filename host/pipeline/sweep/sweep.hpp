// SPDX-License-Identifier: MIT
// Stage `sweep`: transports the injected light of all cascades in one pass over the grid per direction
// (kernels/sweep_*.cl; docs/method.md, 'The sweep').
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "device/kernel.hpp"
#include "device/session.hpp"
#include "kernels/shared/grid.h"
#include "kernels/shared/sweep.h"
#include "options/stage_options.hpp"
#include "pipeline/sweep/bounce.hpp"
#include "pipeline/sweep/sweep_medium.hpp"
#include "pipeline/sweep/sweep_volumes.hpp"
#include "scene/sky.hpp"
#include "volume/volume.hpp"

namespace clpv {

static_assert(sizeof(ClpvSweepBin) == CLPV_SIZEOF_SWEEP_BIN &&
              sizeof(ClpvSweepDirection) == CLPV_SIZEOF_SWEEP_DIRECTION &&
              sizeof(ClpvSweepHalo) == CLPV_SIZEOF_SWEEP_HALO);

/// Sweeps the cascades of a frame, coarsest first. Deterministic to the bit for any number of compute units.
class Sweeper {
 public:
  /// `basis`: of injected light; results are in swept_basis(). `transport`: TransportKind::sweep, which also gives
  /// the blocking mode.
  Sweeper(Session& session, const Basis& basis, const Transport& transport, const SweepOptions& options);

  /// Sets where a cascade lies in SweepOptions::medium, and the light of `lights` that the medium scatters there, multiplied by
  /// `scale`. Call before each sweep() in a medium.
  void set_medium(std::size_t cascade, const ClpvGrid& grid, const std::vector<ShadowedLight>& lights,
                  float scale);

  /// Computes the transmittance of a cascade's links from a geometry volume of (grid + 1)^3 samples.
  void set_blockers(std::size_t cascade, const Volume& geometry);

  /// Sets the reflectors of a cascade (ReflectorVoxelizer), for SweepOptions::bounces other than one. `reflectors`
  /// must outlive the sweeper. Call after set_blockers(): the series of all bounces depends on both.
  void set_reflectors(std::size_t cascade, const Volume& reflectors);

  /// Sets the sky that lights the coarsest cascade at its border.
  void set_sky(const Sky& sky);
  /// Sets the number that volumes store for 1 W/sr, by which the sky is multiplied.
  void scale_sky(float scale) { sky_scale_ = scale; }

  /// Sweeps `injected` through cascade `cascade` of `grids`, after the next coarser one. Writes light of
  /// swept_basis(), as radiance times s^2, to `accumulated`. Throws Error(run_time) for grids that are not nested.
  void sweep(std::size_t cascade, const std::vector<ClpvGrid>& grids, const Volume& injected,
             Volume& accumulated);

  /// Cells of a cascade whose light a sweep stores for the next finer one; empty for the finest.
  ClpvSweepHalo halo(std::size_t cascade, const std::vector<ClpvGrid>& grids) const;

  /// Returns true if a launch sweeps whole bins (kernels/sweep/sweep_bins.cl), false if it sweeps a plane
  /// (kernels/sweep/sweep_planes.cl).
  bool whole_bins() const;

 private:
  /// Directions, kernels and boundary light of one cascade.
  struct Pass {
    int parts, coarser;          ///< parts of the bins of this cascade and of the next coarser one; 0: none
    Buffer directions;           ///< ClpvSweepDirection
    Buffer coefficients, means;  ///< SweepMeans
    Kernel sweep;
    std::optional<Kernel> border;      ///< boundary condition from the coarser cascade; none for the coarsest
    Buffer halo_light;                 ///< boundary light for the next finer cascade
    std::optional<Kernel> sky_border;  ///< boundary condition from the sky; for the coarsest under a sky
    Buffer sky;                        ///< swept_sky()
  };
  using Passes = std::vector<Pass>;  ///< one per cascade
  ProgramSource sweep_program(int coefficients, int emitting, int parts) const;
  Passes make_passes(const Basis& basis, const std::vector<int>& parts);
  bool set_boundary(Passes& passes, std::size_t cascade, const std::vector<ClpvGrid>& grids);
  bool set_boundary(Pass& coarsest, float cell);
  void set_dark_boundary(const Pass& pass);
  void launch_border(Kernel& kernel, const Pass& pass);
  void set_sources(const Volume& light);
  void sweep_cascade(Passes& passes, std::size_t cascade, const std::vector<ClpvGrid>& grids);
  void launch(Pass& pass, std::size_t cascade, const Buffer& sums, const ClpvSweepHalo& halo, bool lit);
  void add_bounces(std::size_t cascade, const std::vector<ClpvGrid>& grids, const Volume& injected);
  void add_series(float cell, const Volume& injected);
  void add_bounces_in_medium(std::size_t cascade, const std::vector<ClpvGrid>& grids, const Volume& injected);
  void collect(std::size_t cascade, Volume& accumulated);
  bool scatters() const;  ///< there is a medium that scatters light
  cl_int upstream_plane(const Pass& pass) const;

  Session& session_;
  SweepOptions options_;
  SweepVolumes volumes_;
  Buffer bins_, sources_, lit_;  ///< sources_, lit_: sweep_source.cl
  Buffer sums_, plane_buffer_, border_;
  std::vector<Buffer> links_;  ///< transmittance of the links of each cascade
  Kernel source_, collect_;
  std::optional<Kernel> transmittance_, collect_with_incident_;
  Passes passes_;
  std::optional<Bouncer> bouncer_;  ///< none with one bounce
  /// Along 24 directions, for incident flux: of each cascade, or with all bounces of the coarsest one.
  Passes bounce_passes_;
  std::unique_ptr<Volume> bounced_;  ///< injected and reflected light; null with one bounce
  std::optional<SweepMedium> medium_;
  bool scattered_swept_ = false;  ///< next sweep includes multiply scattered light
  Buffer first_swept_;            ///< D_1 of docs/method.md; only with all bounces
  float sky_scale_ = 1;
};

}  // namespace clpv
