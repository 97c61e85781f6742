// SPDX-License-Identifier: MIT
#include "scene/deform.hpp"

namespace clpv {
namespace {

constexpr double kShortestNormal = 1e-6;  // a shorter normal is none: the stored one stays

void add_target(const MorphTarget& target, double weight, std::vector<LocalVertex>& vertices) {
  if (weight == 0) return;
  for (std::size_t i = 0; i < target.positions.size(); ++i)
    vertices[i].position += weight * glm::dvec3(target.positions[i]);
  for (std::size_t i = 0; i < target.normals.size(); ++i)
    vertices[i].normal += weight * glm::dvec3(target.normals[i]);
}

}  // namespace

std::vector<LocalVertex> morphed(const LocalPrimitive& primitive, std::span<const double> weights) {
  std::vector<LocalVertex> vertices = primitive.vertices;
  for (std::size_t t = 0; t < primitive.targets.size(); ++t)
    add_target(primitive.targets[t], weights[t], vertices);
  if (primitive.flat) {
    for (const glm::uvec3& t : primitive.triangles) {
      const glm::dvec3 normal = triangle_normal(vertices, t);
      for (int i = 0; i < 3 && normal != glm::dvec3(0); ++i) vertices[t[i]].normal = normal;
    }
    return vertices;
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    glm::dvec3& normal = vertices[i].normal;
    normal = glm::length(normal) < kShortestNormal ? primitive.vertices[i].normal : glm::normalize(normal);
  }
  return vertices;
}

glm::dmat4 blended(const Influence& influence, std::span<const glm::dmat4> joints) {
  glm::dmat4 sum(0.0);
  for (int i = 0; i < 4; ++i) {
    if (influence.weights[i] > 0) sum += influence.weights[i] * joints[influence.joints[i]];
  }
  return sum;
}

}  // namespace clpv
