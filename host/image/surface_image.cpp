// SPDX-License-Identifier: MIT
#include "image/surface_image.hpp"

#include <cmath>

#include "kernels/shared/normal.h"

namespace clpv {
namespace {

constexpr double kSteps = CLPV_NORMAL_STEPS, kZero = CLPV_NORMAL_ZERO, kBase = CLPV_NORMAL_BASE;

/// Folds the lower half of the octahedron over the upper one, and back.
glm::dvec2 fold(const glm::dvec2& at) {
  return {std::copysign(1 - std::abs(at.y), at.x), std::copysign(1 - std::abs(at.x), at.y)};
}

}  // namespace

glm::dvec3 geometric_normal(const glm::vec4& normal) {
  if (!(normal.w > 0)) return glm::dvec3(normal);
  const double row = std::floor(double{normal.w} / kBase);
  glm::dvec2 at((double{normal.w} - kBase * row - kZero) / kSteps, (row - kZero) / kSteps);
  const double z = 1 - std::abs(at.x) - std::abs(at.y);
  if (z < 0) at = fold(at);
  return glm::normalize(glm::dvec3(at, z));
}

glm::dvec3 lift_normal(const glm::dvec3& shading, const glm::dvec3& geometric) {
  return glm::dot(shading, geometric) > double{CLPV_SAME_LIFT} ? shading : geometric;
}

glm::dvec3 lift_normal(const glm::vec4& normal) {
  return lift_normal(glm::dvec3(normal), geometric_normal(normal));
}

glm::vec4 stored_normal(const glm::dvec3& shading, const glm::dvec3& geometric) {
  if (glm::dot(shading, geometric) > double{CLPV_SAME_NORMAL}) return {glm::vec3(shading), 0.0f};
  const glm::dvec3 on =
      geometric / (std::abs(geometric.x) + std::abs(geometric.y) + std::abs(geometric.z));
  const glm::dvec2 at = on.z < 0 ? fold(glm::dvec2(on)) : glm::dvec2(on);
  const glm::dvec2 steps = glm::roundEven(kSteps * at) + kZero;
  return {glm::vec3(shading), static_cast<float>(steps.x + kBase * steps.y)};
}

}  // namespace clpv
