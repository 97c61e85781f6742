// SPDX-License-Identifier: MIT
// Late light carried to a finer cascade, in double: the twin of kernels/carry_late.cl.
#pragma once

#include "kernels/shared/grid.h"
#include "reference/volume.hpp"

namespace clpv::reference {

/// Adds `light` of the cells of `coarser` to `sum`, of the cells of `finer`: sampled trilinearly at their centres,
/// wherever these are, zero beyond the coarser grid, and scaled by the ratio of the cells' areas [W/sr].
void carry_late(const Volume& light, const ClpvGrid& coarser, Volume& sum, const ClpvGrid& finer);

}  // namespace clpv::reference
