// SPDX-License-Identifier: MIT
#include "scene/medium.hpp"

#include <algorithm>

#include "scene/scene.hpp"

namespace clpv {

MediumPart medium_part(const ClpvMedium& medium, const glm::dvec3& origin,
                       const glm::dvec3& direction, double end) {
  if (vector(medium.extinction) == glm::dvec3(0)) return {};
  MediumPart part{0, end};
  for (int axis = 0; axis < 3; ++axis) {
    const double lower = double{medium.lower[axis]} - origin[axis],
                 upper = double{medium.upper[axis]} - origin[axis];
    if (direction[axis] == 0) {
      if (lower > 0 || upper < 0) return {};
      continue;
    }
    const double a = lower / direction[axis], b = upper / direction[axis];
    part.start = std::max(part.start, std::min(a, b));
    part.end = std::min(part.end, std::max(a, b));
  }
  return part;
}

glm::dvec3 transmittance(const ClpvMedium& medium, const MediumPart& part) {
  return glm::exp(-part.length() * vector(medium.extinction));
}

}  // namespace clpv
