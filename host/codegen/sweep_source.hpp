// SPDX-License-Identifier: MIT
// Generated text and tables of the kernels that sweep (kernels/sweep*.cl).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "basis/basis.hpp"
#include "basis/sweep.hpp"
#include "codegen/linear_code.hpp"
#include "kernels/shared/sweep.h"
#include "volume/volume_format.hpp"

namespace clpv {

/// "#define CLPV_EACH_X_BIN(DO) DO(0) ..." and the like: the bins that are swept across each axis, those across x first.
std::string sweep_bin_macros();
/// Generated text, and what it executes a cell and channel.
struct CountedText {
  std::string text;
  OperationCount operations;
};
/// For sweep_source.cl: coefficient_macros, the struct Swept, and clpv_bin_means.
CountedText sweep_source_text(const Basis& basis);
/// For sweep_ways.cl: transmit_source's text, and which ways go where.
std::string sweep_ways_text(const Basis& basis, const Transport& transport);
/// For sweep_collect.cl: coefficient_macros of swept_basis(), the struct Swept, and clpv_projected.
CountedText sweep_collect_text();

/// Of a grid (kernels/sweep.h): numbers in a volume of planes, in a plane by itself, and in a volume with a border.
std::size_t sweep_volume_numbers(int grid);
std::size_t sweep_plane_numbers(int grid);
std::size_t sweep_bordered_numbers(int grid);
/// Volumes that sweep_ways.cl writes.
int sweep_way_count();

/// Whether injected light can be swept from where it lies: it is the bins' means, row by row. So are those across z alone; rows of
/// those across x lie along y there, and of planes across y each lies in another page of memory (1.25 times the time).
bool swept_in_place(const Basis& basis, const VolumeFormat& injected);
/// `injected`: where light is swept from, if swept_in_place(); none: all of it from volumes of planes.
std::vector<ClpvSweepBin> sweep_bin_table(int grid, const std::optional<VolumeFormat>& injected = {});
/// `coarser_parts`: of the next coarser cascade; 0: there is none.
std::vector<ClpvSweepDirection> sweep_direction_table(int parts, int coarser_parts);

}  // namespace clpv
