// SPDX-License-Identifier: MIT
// Stage `sweep`: transports the injected light of all cascades in one pass over the grid per
// direction (kernels/sweep/; docs/method.md, 'The sweep').
#pragma once

#include <array>
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
#include "pipeline/raster/shadow_maps.hpp"
#include "pipeline/sweep/bounce.hpp"
#include "pipeline/sweep/sweep_medium.hpp"
#include "pipeline/sweep/sweep_plan.hpp"
#include "pipeline/sweep/sweep_tables.hpp"
#include "pipeline/sweep/sweep_volumes.hpp"
#include "volume/volume.hpp"

namespace clpv {

/// Light that a sweep of a cascade transports.
struct SweepInput {
  std::size_t cascade;
  const std::vector<ClpvGrid>& grids;  ///< grids of all cascades, finest first
  const Volume& injected;
  float sky_scale = 1;  ///< number that volumes store for 1 W/sr
  std::vector<ShadowedLight> lights =
      {};  ///< those that a medium scatters, scaled like the volumes
};

/// Sweeps the cascades of a frame, coarsest first. Deterministic to the bit for any number of
/// compute units.
class Sweeper {
 public:
  /// `basis`: of injected light; results are in swept_basis(). `transport`: TransportKind::sweep,
  /// which also gives the blocking mode.
  Sweeper(Session& session, const Basis& basis, const Transport& transport,
          const SweepOptions& options);

  /// Computes the transmittance of a cascade's links, and what its border sees of the next coarser
  /// cascade. `geometry`: with SweepOptions::blocking, (grid + 1)^3 samples. `occluded`: with
  /// SweepOptions::points, bits of visibility_masks() for all cascades.
  void set_blockers(std::size_t cascade, const std::vector<ClpvGrid>& grids, const Volume* geometry,
                    const Buffer& occluded = {});

  /// Sets the surfaces of a cascade after those of the next coarser one and after its blockers.
  /// `white`, `reflectors`: reflector_masks(), white and, for SweepOptions::bounces other than one,
  /// coloured. Sweeps the white furnace, writes its light, as radiance, to channel 3 of
  /// `accumulated`, and normalises the reflectors. With all bounces, computes their series in this
  /// cascade from the reflectors and the links.
  void set_surfaces(std::size_t cascade, const std::vector<ClpvGrid>& grids, const Volume& white,
                    const Volume* reflectors, Volume& accumulated);

  /// Sweeps a cascade after the next coarser one. Writes light of swept_basis(), as radiance times
  /// s^2, to channels 0 to 2 of `accumulated`. Throws Error(run_time) for grids that are not
  /// nested.
  void sweep(const SweepInput& input, Volume& accumulated);

  /// Cells of a cascade whose light a sweep stores for the next finer one; empty for the finest.
  ClpvSweepHalo halo(std::size_t cascade, const std::vector<ClpvGrid>& grids) const;

  /// How a cascade is swept: never SweepForm::suited.
  SweepForm form() const;

 private:
  /// Which sweep's border light a halo holds for the next finer cascade: the last, an earlier one,
  /// if the finer cascade's earlier sweeps take that, and the same of the white furnace.
  enum Halo : std::size_t { kLast, kEarlier, kWhite, kWhiteEarlier, kHalos };
  /// Directions of one cascade, their kernels and light at its border.
  struct Directions {
    int parts, coarser;  ///< parts of the bins of this cascade and of the next coarser one; 0: none
    Buffer table;        ///< ClpvSweepDirection
    Buffer white_table;  ///< the same for the white furnace, whose light has the unit s^2
    Buffer coefficients, means;  ///< SweepMeans
    Buffer links;                ///< transmittance
    Kernel sweep;
    std::array<Buffer, kHalos> halos = {};  ///< border light of the next finer cascade
    std::optional<Kernel> border = {};      ///< from the coarser cascade; none for the coarsest
    Buffer hidden = {}, closed = {};        ///< what the border sees of the coarser cascade
    std::optional<Kernel> count_hidden = {};
    std::optional<Kernel> sky_border = {};  ///< from the sky; for the coarsest
    Buffer sky = {}, white_sky = {};  ///< swept_sky(); of the scene's sky, if any, and an even one
  };
  Directions make_directions(const Basis& basis, std::size_t cascade) const;
  ProgramSource sweep_program(int coefficients, const SweepMeans& means, int parts) const;
  void enter_medium(std::size_t cascade, const ClpvGrid& grid);
  void run(const SweepStep& step, Halo halo, const SweepInput& input);
  void set_sources(const SweepStep& step, const SweepInput& input);
  void sweep_white(Halo halo, std::size_t cascade, const std::vector<ClpvGrid>& grids);
  bool light_border(Halo halo, std::size_t cascade, const std::vector<ClpvGrid>& grids,
                    const Buffer& sky, float sky_scale, cl_int first_lit = 0,
                    bool rows_stand = false);
  void darken_border(const Directions& directions);
  ClpvSweepHalo prepare_halo(Halo halo, std::size_t cascade, const std::vector<ClpvGrid>& grids);
  void launch(Halo halo, std::size_t cascade, const ClpvSweepHalo& stored, bool lit,
              bool scattered = false);
  void collect(Volume& accumulated, int first, int channels);
  bool blocks() const { return options_.blocking || options_.points; }
  bool last_light_enters() const;
  Halo entering(Halo halo) const;
  bool feeds_finer(Halo halo, std::size_t cascade) const;
  std::size_t group() const;

  Session& session_;
  SweepOptions options_;
  SweepVolumes volumes_;
  Buffer bins_;
  SweepSources sources_;
  Buffer hidden_;  ///< seen_points.cl
  /// Results of the last two sweeps; last_swept_: only for SweptLight::series.
  Buffer swept_, last_swept_;
  Buffer plane_buffer_, border_;
  std::optional<Halo> bordered_;  ///< of which a sweep() has set the boundary condition last
  Kernel source_, collect_, join_furnace_;
  std::optional<Kernel> count_hidden_points_, transmittance_;
  std::optional<SweepMedium> medium_;
  std::vector<SweepStep> plan_;
  std::vector<Directions> cascades_;
  Bouncer bouncer_;
};

}  // namespace clpv
