// SPDX-License-Identifier: MIT
#include "reference/medium.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/scene.hpp"

namespace clpv::reference {

MediumPart medium_part(const ClpvMedium& medium, const glm::dvec3& origin, const glm::dvec3& direction, double end) {
  if (!attenuates(medium)) return {};
  MediumPart part{0, end};
  for (int axis = 0; axis < 3; ++axis) {
    const double lower = double{medium.lower[axis]} - origin[axis], upper = double{medium.upper[axis]} - origin[axis];
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

double phase(double g, double cosine) {
  const double d = 1 + g * g - 2 * g * cosine;
  return (1 - g * g) / (4 * std::numbers::pi * d * std::sqrt(d));
}

bool attenuates(const ClpvMedium& medium) {
  return vector(medium.extinction) != glm::dvec3(0);
}

}  // namespace clpv::reference
