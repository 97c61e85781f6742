// SPDX-License-Identifier: MIT
// CPU reference of kernels/raster/surface.h: projection between pixels and world positions, in
// double.
#pragma once

#include <glm/glm.hpp>

#include "kernels/shared/view.h"
#include "scene/scene.hpp"

namespace clpv::reference {

/// z-component of the cross product.
inline double cross(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

/// Returns the world position [m] at depth [m] of pixel (px, py). Pixel centres have integer
/// coordinates.
glm::dvec3 surface_position(const ClpvView& view, double px, double py, double depth);
/// The same of the pixel with that number, row by row.
inline glm::dvec3 surface_position(const ClpvView& view, std::size_t pixel, double depth) {
  return surface_position(view, pixel % view.width, pixel / view.width, depth);
}

/// Returns the unit vector from `position` [m] to the eye; 0 for points without a view.
glm::dvec3 towards_eye(const ClpvView& view, const glm::dvec3& position);

/// Projection of a point: pixel coordinates (pixel centres are integers) and depth [m]. In
/// perspective views valid for depth > 0.
struct ProjectedPoint {
  glm::dvec2 pixel{0};
  double depth = 0;
};
ProjectedPoint project(const ClpvView& view, const glm::dvec3& point);

/// Returns the distance [m] between adjacent pixels' positions on a plane across `forward` at
/// `depth` [m].
double pixel_edge(const ClpvView& view, double depth);

/// Returns the area [m^2] of a pixel's footprint across its ray; perspective: distance^2 times the
/// pixel's solid angle.
double footprint(const ClpvView& view, double px, double py, double depth);

}  // namespace clpv::reference
