// SPDX-License-Identifier: MIT
// CPU reference of kernels/steps/transmittance.cl: transmittance of a link into a cell, T = 1 -
// clamp(B, 0, 1) (docs/method.md, 'Blockers').
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <set>
#include <vector>

#include "reference/volume.hpp"

namespace clpv::reference {

/// Returns T in [0, 1]. B = weights . mean of the blockers over the corners of `cell` on `side`
/// (components -1, 0, 1). `weights`: blocked_by of a Face or SweepLink. `geometry`: (n+1)^3
/// corners, one channel.
double transmittance(const Volume& geometry, const glm::ivec3& cell, const glm::ivec3& side,
                     const std::vector<double>& weights);

/// Returns the transmittance of a link into `cell` from `side`: of the sample points about it, the
/// share that see both of its ends among those that see one (kernels/sweep/sweep_links.cl).
/// `occluded`: bits of visibility_masks(), n^3 cubes; outside the grid centres see
/// what those at the border see.
double seen_share(const std::vector<std::uint8_t>& occluded, int n, const glm::ivec3& cell,
                  const glm::ivec3& side);

/// Centres of cells, by their numbers along x, y, z.
using SeenCentres = std::set<std::array<int, 3>>;

/// Returns what each of the eight sample points in a cell of the next finer cascade sees of the
/// centres about it. `at`: the cell, in cells from the first centre. Without `occluded` and outside
/// the grid points see all (kernels/sweep/sweep_border.cl).
std::vector<SeenCentres> seen_centres(const std::vector<std::uint8_t>* occluded, int n,
                                      const glm::dvec3& at);

}  // namespace clpv::reference
