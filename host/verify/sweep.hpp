// SPDX-License-Identifier: MIT
// Job of stages `sweep` and `bounce`: injected light of nested cascades to swept light.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "device/session.hpp"
#include "kernels/shared/grid.h"
#include "options/stage_options.hpp"
#include "reference/shade.hpp"
#include "scene/sky.hpp"
#include "verify/job.hpp"

namespace clpv::verify {

/// Cascades, finest first. Without a sky the border is dark.
struct SweepProblem {
  std::shared_ptr<const Basis> basis;
  Transport transport;
  SweepOptions options;
  std::vector<ClpvGrid> grids;
  std::vector<SharedVolume> light;
  std::vector<SharedVolume> blockers;    ///< read with SweepOptions::blocking
  std::vector<SharedVolume> reflectors;  ///< read with several bounces
  /// Faces of the white furnace; empty: no furnace is swept, as while geometry stands still.
  std::vector<SharedVolume> white = {};
  std::optional<Sky> sky = {};
  float sky_scale = 1;
  std::vector<reference::MappedLight> lights = {};  ///< in SweepOptions::medium
  float medium_scale = 1;
  /// Bits of visibility_masks() for each cascade, which close links; empty: none.
  std::vector<std::vector<std::uint8_t>> occluded = {};
};

/// `cost` is that of one cascade with a dark border, one bounce and no medium; its time includes
/// the links' transmittance.
Job sweep_job(Session& session, const SweepProblem& problem, const Share& share = not_shared);

/// A problem with random light, blockers and reflectors, and lights in the medium if the options
/// have one.
SweepProblem random_sweep(const std::shared_ptr<const Basis>& basis, const Transport& transport,
                          const SweepOptions& options);

}  // namespace clpv::verify
