// SPDX-License-Identifier: MIT
// Axis-aligned boxes.
#pragma once

#include <glm/glm.hpp>

namespace clpv {

/// An axis-aligned box [m].
struct Bounds {
  glm::vec3 lower{0}, upper{0};
};

}  // namespace clpv
