// SPDX-License-Identifier: MIT
#include "reference/screen_polygon.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/shared/raster.h"
#include "reference/view.hpp"

namespace clpv::reference {
namespace {

double depth_of(const ClpvView& view, const glm::dvec3& p) {
  double depth = 0;
  for (int i = 0; i < 3; ++i) depth += (p[i] - view.eye[i]) * view.forward[i];
  return depth;
}

/// Clips the triangle at the near plane; returns a polygon.
std::vector<glm::dvec3> clipped(const ClpvView& view, const std::array<glm::dvec3, 3>& corners) {
  if (view.orthographic != 0) return {corners.begin(), corners.end()};
  std::vector<glm::dvec3> polygon;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 &a = corners[i], &b = corners[(i + 1) % 3];
    const double da = depth_of(view, a) - view.near_depth, db = depth_of(view, b) - view.near_depth;
    if (da >= 0) polygon.push_back(a);
    if ((da >= 0) != (db >= 0)) polygon.push_back(a + (b - a) * (da / (da - db)));
  }
  return polygon;
}

glm::dvec2 centre(unsigned px, unsigned py) {
  return (glm::dvec2(px, py) + 0.5) * static_cast<double>(CLPV_SUBPIXELS);
}

/// Returns true if the point is left of the edge from a to b, or on it if it is a top or left edge.
/// For triangles that are clockwise on the screen (y down).
bool inside_edge(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& point) {
  const double side = cross(b - a, point - a);
  const bool top_left = b.y < a.y || (b.y == a.y && b.x > a.x);
  return side > 0 || (side == 0 && top_left);
}

bool inside_triangle(glm::dvec2 a, glm::dvec2 b, const glm::dvec2& c, const glm::dvec2& point) {
  const double area = cross(b - a, c - a);
  if (area == 0) return false;
  if (area < 0) std::swap(a, b);
  return inside_edge(a, b, point) && inside_edge(b, c, point) && inside_edge(c, a, point);
}

double distance_to_segment(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& point) {
  const glm::dvec2 along = b - a;
  const double length2 = glm::dot(along, along);
  const double t = length2 > 0 ? std::clamp(glm::dot(point - a, along) / length2, 0.0, 1.0) : 0.0;
  return glm::length(point - (a + t * along));
}

}  // namespace

ScreenPolygon::ScreenPolygon(const ClpvView& view, const std::array<glm::dvec3, 3>& corners) {
  nearest_ = std::numeric_limits<double>::max();
  farthest_ = std::numeric_limits<double>::lowest();
  for (const glm::dvec3& corner : clipped(view, corners)) {
    const ProjectedPoint projected = project(view, corner);
    const glm::dvec2 at = (projected.pixel + 0.5) * static_cast<double>(CLPV_SUBPIXELS);
    corners_.emplace_back(std::nearbyint(at.x), std::nearbyint(at.y));
    nearest_ = std::min(nearest_, projected.depth);
    farthest_ = std::max(farthest_, projected.depth);
  }
  double area = 0;
  for (std::size_t i = 0; i < corners_.size(); ++i)
    area += cross(corners_[i], corners_[(i + 1) % corners_.size()]);
  front_ = area < 0;  // y points down
}

bool ScreenPolygon::covers(unsigned px, unsigned py) const {
  for (std::size_t i = 2; i < corners_.size(); ++i) {
    if (inside_triangle(corners_[0], corners_[i - 1], corners_[i], centre(px, py))) return true;
  }
  return false;
}

double ScreenPolygon::distance_to_edge(unsigned px, unsigned py) const {
  double smallest = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    smallest = std::min(
        smallest,
        distance_to_segment(corners_[i], corners_[(i + 1) % corners_.size()], centre(px, py)));
  }
  return smallest / int{CLPV_SUBPIXELS};
}

}  // namespace clpv::reference
