// SPDX-License-Identifier: MIT
// Stage `sweep` in double: the CPU reference of kernels/sweep.cl and of the kernels round it (docs/method.md, 'The sweep').
#pragma once

#include <vector>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "kernels/shared/grid.h"
#include "reference/volume.hpp"
#include "scene/sky.hpp"

namespace clpv::reference {

/// What one cascade's sweep starts from.
struct SweptCascade {
  ClpvGrid grid{};
  const Volume* injected = nullptr;  ///< of the basis [W/sr]
  const Volume* geometry = nullptr;  ///< blocking potential at the cells' corners; null: nothing blocks
  int parts = 1;                     ///< of its bins (sweep_bins)
};

/// Injected light [W/sr] as its means over bins.
Volume in_bins(const Basis& basis, const Volume& injected);

/// The centre of a finer grid's cell, in a coarser grid's cells from the centre of its first one.
glm::dvec3 place_in(const ClpvGrid& coarse, const ClpvGrid& fine, const glm::ivec3& cell);
/// All coefficients of a channel there, trilinear between cells' centres, zero beyond them.
std::vector<double> sampled(const Volume& volume, int channel, const glm::dvec3& at);

/// Light of `bins24`, radiance times s^2, of every cascade: finest first, as `cascades` are. `transport`: TransportKind::sweep.
/// `sky`: shines into the coarsest; null: none.
std::vector<Volume> sweep(const Basis& basis, const Transport& transport,
                          const std::vector<SweptCascade>& cascades, const Sky* sky = nullptr);

/// What is kept of it: light of swept_basis().
Volume kept_of(const Volume& swept);

}  // namespace clpv::reference
