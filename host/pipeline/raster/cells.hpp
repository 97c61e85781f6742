// SPDX-License-Identifier: MIT
// View `cells`: the cells of the finest cascade as small spheres, each shaded by the irradiance
// that its light gives surfaces of every direction, as in views of light probes.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "kernels/shared/grid.h"
#include "kernels/shared/view.h"

namespace clpv {

constexpr double kSphereRadius = 0.2;  // [cells]

/// Visible points of the spheres: pixel, centre of the cell [m], and unit normal of the sphere
/// there.
struct CellSpheres {
  std::vector<std::size_t> pixels;
  std::vector<glm::dvec3> centres, normals;
};

/// Finds the first sphere before the surface in each pixel of a perspective view. `depth` [m], row
/// 0 first; 0 without a surface. The cells next to the eye have no sphere, since it would cover the
/// view.
CellSpheres visible_spheres(const ClpvView& view, const std::vector<float>& depth,
                            const ClpvGrid& grid);

}  // namespace clpv
