// SPDX-License-Identifier: MIT
#include "pipeline/frame/cascade.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/error.hpp"

namespace clpv {
namespace {

// [finer cells]: float32 rounding of origins about 100 cells away.
constexpr double kAligned = 1e-2;

/// Distance of floats at the grid's corner that is farthest from the coordinates' origin [m].
double resolution(const ClpvGrid& grid) {
  double farthest = 0;
  for (const float origin : grid.origin)
    farthest =
        std::max({farthest, -double{origin}, origin + static_cast<double>(grid.n) * grid.cell});
  const auto corner = static_cast<float>(farthest);
  return std::nextafter(corner, std::numeric_limits<float>::infinity()) - corner;
}

/// Rejects cells so small that the rounding of a coarser grid's origin shifts them.
void require_resolved(const std::vector<ClpvGrid>& grids, double size) {
  for (std::size_t c = 0; c < grids.size(); ++c) {
    const double cell = grids[c].cell,
                 least = resolution(grids[std::min(c + 1, grids.size() - 1)]) / kAligned;
    if (cell >= least) continue;
    throw Error(ExitCode::usage,
                "cascade-size: found {:.4g}, with which cascade {} has cells of {:.4g} m, too "
                "small for float coordinates at this camera; allowed here: {:.4g} or more",
                size, c, cell, size * least / cell);
  }
}

}  // namespace

std::vector<ClpvGrid> cascade_grids(const glm::vec3& eye, int count, double size, int cells) {
  std::vector<ClpvGrid> grids;
  for (int c = 0; c < count; ++c) {
    const double cell = std::ldexp(size, c) / cells;
    ClpvGrid grid{};
    grid.cell = cell;
    grid.n = cells;
    for (int axis = 0; axis < 3; ++axis) {
      const double first = std::floor(eye[axis] / cell) - cells / 2;
      grid.origin[axis] = first * cell;
      grid.middle[axis] = eye[axis];
    }
    grids.push_back(grid);
  }
  require_resolved(grids, size);
  return grids;
}

bool cascades_meet(const SceneData& scene, const glm::vec3& eye, int count, double size,
                   int cells) {
  const ClpvGrid grid = cascade_grids(eye, count, size, cells).back();
  const glm::vec3 lower(grid.origin[0], grid.origin[1], grid.origin[2]);
  const glm::vec3 upper = lower + grid.cell * static_cast<float>(cells);
  const auto corner = [&](unsigned vertex) {
    const auto& p = scene.vertices[vertex].position;
    return glm::vec3(p[0], p[1], p[2]);
  };
  return std::ranges::any_of(scene.triangles, [&](const Triangle& t) {
    const glm::vec3 a = corner(t.vertex[0]), b = corner(t.vertex[1]), c = corner(t.vertex[2]);
    return glm::all(glm::lessThan(glm::min(a, glm::min(b, c)), upper)) &&
           glm::all(glm::greaterThan(glm::max(a, glm::max(b, c)), lower));
  });
}

bool reaches(const ClpvGrid& grid, const glm::dvec3& position) {
  const glm::dvec3 off =
      glm::abs(position - glm::dvec3(grid.middle[0], grid.middle[1], grid.middle[2]));
  return glm::all(glm::lessThan(off, glm::dvec3(grid_reach(grid.n) * double{grid.cell})));
}

}  // namespace clpv
