// SPDX-License-Identifier: MIT
#include "volume/volume_files.hpp"

#include <array>

#include "support/array_files.hpp"

namespace clpv {

void write_volume_npy(const std::filesystem::path& path, const std::vector<float>& values, int cells,
                      int coefficients) {
  const std::size_t n = cells;
  const std::array<std::size_t, 5> shape{3, static_cast<std::size_t>(coefficients), n, n, n};
  write_npy(path, values, shape);
}

void write_volume_vti(const std::filesystem::path& path, const std::vector<float>& values,
                      const ClpvGrid& grid, int coefficients) {
  const std::size_t cells = static_cast<std::size_t>(grid.n) * grid.n * grid.n;
  const std::size_t components = coefficients;
  // A .vti stores all components of a cell together; volumes store all cells of a component together.
  std::array<std::vector<float>, 3> channels;
  for (std::size_t c = 0; c < 3; ++c) {
    channels[c].resize(cells * components);
    for (std::size_t i = 0; i < components; ++i) {
      for (std::size_t p = 0; p < cells; ++p)
        channels[c][p * components + i] = values[(c * components + i) * cells + p];
    }
  }
  VtiGrid vti_grid;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    vti_grid.cells[axis] = grid.n;
    vti_grid.origin[axis] = grid.origin[axis];
    vti_grid.spacing[axis] = grid.cell;
  }
  const std::array<VtiArray, 3> arrays{VtiArray{"red", coefficients, channels[0]},
                                       VtiArray{"green", coefficients, channels[1]},
                                       VtiArray{"blue", coefficients, channels[2]}};
  write_vti(path, vti_grid, arrays);
}

}  // namespace clpv
