// SPDX-License-Identifier: MIT
#include "reference/view.hpp"

#include <cmath>

namespace clpv::reference {

glm::dvec3 surface_position(const ClpvView& view, double px, double py, double depth) {
  const double scale = view.orthographic != 0 ? 1.0 : depth;
  const double sx = (2 * (px + 0.5) / view.width - 1) * view.half_width * scale;
  const double sy = (1 - 2 * (py + 0.5) / view.height) * view.half_height * scale;
  return vector(view.eye) + depth * vector(view.forward) + sx * vector(view.right) +
         sy * vector(view.up);
}

glm::dvec3 towards_eye(const ClpvView& view, const glm::dvec3& position) {
  if (view.half_width <= 0) return glm::dvec3(0);
  const glm::dvec3 way = vector(view.eye) - position, forward = vector(view.forward);
  return view.orthographic != 0 ? forward * glm::dot(way, forward) : way;
}

ProjectedPoint project(const ClpvView& view, const glm::dvec3& point) {
  const glm::dvec3 offset = point - vector(view.eye);
  const double depth = glm::dot(offset, vector(view.forward));
  const double scale = view.orthographic != 0 ? 1.0 : depth;
  const double sx = glm::dot(offset, vector(view.right)) / (scale * view.half_width);
  const double sy = glm::dot(offset, vector(view.up)) / (scale * view.half_height);
  return {{(sx + 1) / 2 * view.width - 0.5, (1 - sy) / 2 * view.height - 0.5}, depth};
}

double pixel_edge(const ClpvView& view, double depth) {
  return 2.0 * view.half_width / view.width * (view.orthographic != 0 ? 1.0 : depth);
}

double footprint(const ClpvView& view, double px, double py, double depth) {
  const double pixel =
      4.0 * view.half_width * view.half_height / (static_cast<double>(view.width) * view.height);
  if (view.orthographic != 0) return pixel;
  const double sx = (2 * (px + 0.5) / view.width - 1) * view.half_width;
  const double sy = (1 - 2 * (py + 0.5) / view.height) * view.half_height;
  return depth * depth * pixel / std::sqrt(1 + sx * sx + sy * sy);
}

}  // namespace clpv::reference
