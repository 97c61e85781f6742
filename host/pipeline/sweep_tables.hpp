// SPDX-License-Identifier: MIT
// Tables of bins and directions that the kernels of a sweep read (kernels/shared/sweep.h).
#pragma once

#include <optional>
#include <vector>

#include "basis/basis.hpp"
#include "kernels/shared/sweep.h"
#include "volume/volume_format.hpp"

namespace clpv {

/// Whether injected light can be swept from where it lies: it is the bins' means, row by row. So are those across z alone; rows of
/// those across x lie along y there, and of planes across y each lies in another page of memory (1.25 times the time).
bool swept_in_place(const Basis& basis, const VolumeFormat& injected);
/// `injected`: where light is swept from, if swept_in_place(); none: all of it from volumes of planes.
std::vector<ClpvSweepBin> sweep_bin_table(int grid, const std::optional<VolumeFormat>& injected = {});
/// `coarser_parts`: of the next coarser cascade; 0: there is none.
std::vector<ClpvSweepDirection> sweep_direction_table(int parts, int coarser_parts);

}  // namespace clpv
