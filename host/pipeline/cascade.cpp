#include "pipeline/cascade.hpp"

#include <cmath>

namespace clpv {

std::vector<ClpvGrid> cascade_grids(const glm::vec3& eye, int count, double size, int cells) {
  std::vector<ClpvGrid> grids;
  for (int c = 0; c < count; ++c) {
    const double cell = std::ldexp(size, c) / cells;
    ClpvGrid grid{};
    grid.cell = static_cast<float>(cell);
    grid.n = static_cast<unsigned>(cells);
    for (int axis = 0; axis < 3; ++axis) {
      const double first = std::floor(eye[axis] / cell) - cells / 2;
      grid.origin[axis] = static_cast<float>(first * cell);
    }
    grids.push_back(grid);
  }
  return grids;
}

}  // namespace clpv
