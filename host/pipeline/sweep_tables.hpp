// SPDX-License-Identifier: MIT
// Tables of bins and directions for the kernels of the sweep (kernels/shared/sweep.h).
#pragma once

#include <optional>
#include <vector>

#include "basis/basis.hpp"
#include "kernels/shared/sweep.h"
#include "volume/volume_format.hpp"

namespace clpv {

/// Returns true if bins across z can be swept from the injected volume, which requires bins' means (bins24) in layout
/// soa. Bins across x and y need volumes of planes: the injected volume scatters their rows or planes.
bool swept_in_place(const Basis& basis, const VolumeFormat& injected);
/// `injected`: format of the volume from which bins across z are swept; none: all bins use volumes of planes.
std::vector<ClpvSweepBin> sweep_bin_table(int grid, const std::optional<VolumeFormat>& injected = {});
/// `coarser_parts`: parts of the next coarser cascade; 0 for the coarsest.
std::vector<ClpvSweepDirection> sweep_direction_table(int parts, int coarser_parts);

}  // namespace clpv
