// SPDX-License-Identifier: MIT
#include "scene/instance.hpp"

#include <fmt/format.h>

#include <cmath>

#include "scene/bounds.hpp"
#include "support/refuse.hpp"

namespace clpv {
namespace {

/// What turns normals: the cofactors of M are det(M) times its inverse transpose, so they need no division
/// and work for flattened nodes too; the determinant's sign undoes the flip of a mirrored one.
glm::dmat3 normal_matrix(const glm::dmat3& m) {
  const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  return glm::determinant(m) < 0 ? -cofactors : cofactors;
}

Vertex placed(const LocalVertex& local, const Instance& instance, const glm::dmat4& to_world,
              const glm::dmat3& to_normal, const std::string& file) {
  const glm::dvec3 p(to_world * glm::dvec4(local.position, 1));
  for (int i = 0; i < 3; ++i) {
    if (!(std::abs(p[i]) <= bounds::kCoordinate)) {
      refuse(file, instance.primitive->place,
             fmt::format("vertex {} at ({}, {}, {}) m, placed by /nodes/{}", local.source, p.x, p.y, p.z,
                         instance.node_index),
             fmt::format("coordinates within +-{} m", bounds::kCoordinate));
    }
  }
  glm::dvec3 n = to_normal * local.normal;
  const double length = glm::length(n);
  n = length > 0 && std::isfinite(length) ? n / length : local.normal;  // a node flattened to a line
  const auto f = [](double value) { return static_cast<float>(value); };
  return {{f(p.x), f(p.y), f(p.z)},
          {f(n.x), f(n.y), f(n.z)},
          {local.uv.x, local.uv.y},
          {local.colour.x, local.colour.y, local.colour.z, local.colour.w}};
}

}  // namespace

void place(const Instance& instance, const glm::dmat4& to_world, const std::string& file, Scene& scene) {
  const glm::dmat3 linear(to_world);
  const glm::dmat3 to_normal = normal_matrix(linear);
  const bool mirrored = glm::determinant(linear) < 0;
  const std::uint32_t base = instance.first_vertex;
  Vertex* vertex = scene.vertices.data() + base;
  for (const LocalVertex& local : instance.primitive->vertices) {
    *vertex++ = placed(local, instance, to_world, to_normal, file);
  }
  Triangle* triangle = scene.triangles.data() + instance.first_triangle;
  for (const glm::uvec3& t : instance.primitive->triangles) {
    const std::uint32_t second = base + (mirrored ? t.z : t.y), third = base + (mirrored ? t.y : t.z);
    *triangle++ = {{base + t.x, second, third}, instance.primitive->material};
  }
}

}  // namespace clpv
