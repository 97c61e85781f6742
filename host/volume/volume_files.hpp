// SPDX-License-Identifier: MIT
// Writes light volumes to files: .npy for scripts, .vti for ParaView.
#pragma once

#include <filesystem>
#include <vector>

#include "kernels/shared/grid.h"

namespace clpv {

/// Writes accumulated radiant intensity [W/sr] as .npy: float32, shape (3, N, z, y, x), `values` in that order.
/// Throws Error(run_time) if the file cannot be written.
void write_volume_npy(const std::filesystem::path& path, const std::vector<float>& values, int cells,
                      int coefficients);

/// Writes the same as .vti: positions from `grid`, one array of N components per cell for each of red, green, blue.
void write_volume_vti(const std::filesystem::path& path, const std::vector<float>& values,
                      const ClpvGrid& grid, int coefficients);

}  // namespace clpv
