// SPDX-License-Identifier: MIT
// Light volumes as files: .npy for scripts, .vti for ParaView.
#pragma once

#include <filesystem>
#include <vector>

#include "kernels/shared/grid.h"

namespace clpv {

/// Accumulated radiant intensity [W/sr] as .npy: float32, shape (3, N, z, y, x). `values` in that order.
void write_volume_npy(const std::filesystem::path& path, const std::vector<float>& values, int cells,
                      int coefficients);

/// The same as .vti: point in space by `grid`, and per channel (red, green, blue) one array of N components a cell.
void write_volume_vti(const std::filesystem::path& path, const std::vector<float>& values,
                      const ClpvGrid& grid, int coefficients);

}  // namespace clpv
