// SPDX-License-Identifier: MIT
// Where a view's pixels look, in double: the CPU reference of kernels/surface.h.
#pragma once

#include <glm/glm.hpp>

#include "kernels/shared/view.h"
#include "scene/scene.hpp"

namespace clpv::reference {

inline double cross(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

/// The surface point [m] at depth [m] behind pixel (px, py); pixel centres at whole numbers.
glm::dvec3 surface_position(const ClpvView& view, double px, double py, double depth);
/// The same of the pixel with that number, row by row.
inline glm::dvec3 surface_position(const ClpvView& view, std::size_t pixel, double depth) {
  return surface_position(view, pixel % view.width, pixel / view.width, depth);
}

/// A point as a view sees it: pixel coordinates (pixel centres at whole numbers) and depth [m].
/// Perspective: meaningful where depth > 0.
struct Projected {
  glm::dvec2 pixel{0};
  double depth = 0;
};
Projected project(const ClpvView& view, const glm::dvec3& point);

/// Distance between neighbouring pixels' surface points [m], on a plane across `forward` at that depth [m].
double pixel_edge(const ClpvView& view, double depth);

/// Area [m^2] of a pixel's footprint across its ray; perspective: distance^2 times the pixel's solid angle.
double footprint(const ClpvView& view, double px, double py, double depth);

}  // namespace clpv::reference
