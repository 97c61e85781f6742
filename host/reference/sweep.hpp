// SPDX-License-Identifier: MIT
// CPU reference of the sweep (kernels/sweep*.cl), in double: discrete ordinates with short
// characteristics (docs/method.md, 'The sweep').
#pragma once

#include <cstdint>
#include <vector>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "kernels/shared/grid.h"
#include "reference/volume.hpp"
#include "scene/sky.hpp"

namespace clpv::reference {

/// Input of one cascade's sweep.
struct SweptCascade {
  ClpvGrid grid{};
  const Volume* injected = nullptr;    ///< n^3 cells, coefficients in the basis [W/sr]
  const Volume* geometry = nullptr;    ///< blockers at the cells' corners; null: no blockers
  int parts = 1;                       ///< subdivision of its bins (sweep_bins)
  const ClpvMedium* medium = nullptr;  ///< null: none
  /// The medium's source function, of scattered_in_cells(); null: 0.
  const Volume* scattered = nullptr;
  /// Bits of visibility_masks(), for seen_share() of links; null: 1.
  const std::vector<std::uint8_t>* occluded = nullptr;
};

/// Returns the swept light of every cascade in bins24, as radiance times s^2. `cascades`: finest
/// first. `transport`: TransportKind::sweep. `sky`: boundary condition of the coarsest cascade;
/// null: dark border.
std::vector<Volume> sweep(const Basis& basis, const Transport& transport,
                          const std::vector<SweptCascade>& cascades, const Sky* sky = nullptr);

/// Projects swept light on swept_basis().
Volume project_bins(const Volume& swept);

}  // namespace clpv::reference
