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
#include "volume/volume.hpp"

namespace clpv {

static_assert(sizeof(ClpvSweepBin) == CLPV_SIZEOF_SWEEP_BIN &&
              sizeof(ClpvSweepDirection) == CLPV_SIZEOF_SWEEP_DIRECTION &&
              sizeof(ClpvSweepShell) == CLPV_SIZEOF_SWEEP_SHELL);

/// Sweeps the cascades of a frame, coarsest first. Deterministic to the bit, whatever the number of compute units.
class Sweeper {
 public:
  /// `basis`: of injected light; what comes out is of swept_basis(). `transport`: TransportKind::sweep, which says what blocks.
  Sweeper(Session& session, const Basis& basis, const Transport& transport, const SweepOptions& options);

  /// What blocks in a cascade from now on: (grid + 1)^3 samples.
  void block(std::size_t cascade, const Volume& geometry);

  /// Sweeps `injected` through cascade `cascade` of `grids`, whose coarser one has been swept before, and leaves light of
  /// swept_basis(), as radiance times s^2, in `accumulated`. Throws Error(run_time) for grids that are not nested.
  void sweep(std::size_t cascade, const std::vector<ClpvGrid>& grids, const Volume& injected,
             Volume& accumulated);

  /// The cells of a cascade whose light a sweep of it keeps for the next finer one; those of the finest are none.
  ClpvSweepShell shell(std::size_t cascade, const std::vector<ClpvGrid>& grids) const;

  /// Device memory of all that a sweeper keeps [bytes].
  static double bytes(const SweepOptions& options);

 private:
  struct Pass {  ///< of a cascade
    int parts;
    Buffer directions;  ///< ClpvSweepDirection
    Buffer ways;        ///< transmittance
    Kernel sweep;
    std::optional<Kernel> let_in;  ///< none: nothing is beyond
    Buffer shell;                  ///< light for the next finer cascade
  };
  Pass make_pass(std::size_t cascade);
  void launch_tiles(Kernel& kernel, int channels);
  void let_in(std::size_t cascade, const std::vector<ClpvGrid>& grids);
  void sweep(Pass& pass, const ClpvSweepShell& shell);
  bool whole_bins() const;

  Session& session_;
  SweepOptions options_;
  int tile_;  ///< cells along the edges of a tile
  Buffer bins_, light_, live_, border_;
  Kernel source_, collect_;
  std::optional<Kernel> ways_;
  std::vector<Pass> passes_;
};

}  // namespace clpv
