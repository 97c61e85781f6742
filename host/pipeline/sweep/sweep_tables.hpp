// SPDX-License-Identifier: MIT
// Tables of bins and directions for the kernels of the sweep (kernels/shared/sweep.h).
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "basis/basis.hpp"
#include "basis/sweep.hpp"
#include "kernels/shared/grid.h"
#include "kernels/shared/light.h"
#include "kernels/shared/sweep.h"

namespace clpv {

std::vector<ClpvSweepBin> sweep_bin_table(int grid);
/// `coarser_parts`: parts of the next coarser cascade; 0 for the coarsest.
std::vector<ClpvSweepDirection> sweep_direction_table(int parts, int coarser_parts);

/// Sets the attenuation of a table's directions by a medium, for cells of edge `cell` [m].
void attenuate(std::vector<ClpvSweepDirection>& table, int parts, const ClpvMedium& medium,
               double cell);

/// Share of each cell inside the medium's box, as factors in [0, 1] for x, y and z to be
/// multiplied. Three rows of bordered_pitch(n) numbers, cell i at CLPV_SWEEP_FIRST + i, with the
/// halo's cells.
std::vector<float> cells_in_medium(const ClpvMedium& medium, const ClpvGrid& grid);

/// part_means() without the coefficients that no direction of a bin depends on (they belong to
/// other bins).
struct SweepMeans {
  int emitting;                   ///< coefficients per bin, the most of any bin
  std::vector<int> coefficients;  ///< 24 x emitting
  std::vector<float> means;       ///< 24 parts^2 x emitting; 0 for entries that a bin does not need
  std::optional<CosineRest> rest;  ///< cosine_rest()
};
SweepMeans sweep_means(const Basis& basis, int parts);

/// Returns the offset from the coarser grid's minimum corner to the finer one's, in finer cells.
/// Throws Error(run_time) if the finer grid is not half as wide, or not inside the coarser one.
std::array<int, 3> offset_in_coarser(const ClpvGrid& coarser, const ClpvGrid& finer);

}  // namespace clpv
