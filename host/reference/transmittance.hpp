// SPDX-License-Identifier: MIT
// The CPU reference of kernels/transmittance.cl: what blockers let through on one link into a cell (docs/method.md, 'Propagation').
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "reference/volume.hpp"

namespace clpv::reference {

/// 1 - B in [0, 1], B the mean blocker over those corners of `cell` that lie towards `side` (components -1, 0, 1), by
/// `weights` of its numbers: a Face's or Neighbour's blocked_by. `geometry`: (n+1)^3 corners, one channel.
double transmitted(const Volume& geometry, const glm::ivec3& cell, const glm::ivec3& side,
                   const std::vector<double>& weights);

}  // namespace clpv::reference
