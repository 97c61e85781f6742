// SPDX-License-Identifier: MIT
#include "scene/primitive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/bounds.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

constexpr glm::dvec3 kUp{0, 1, 0};   // normal of vertices that only degenerate triangles use
constexpr double kMinNormal = 1e-6;  // shorter stored normals count as missing

/// Corners of triangle `i`, counter-clockwise seen from its front (glTF 2.0, section 3.7.2.1).
glm::uvec3 corners_of(TriangleOrder order, std::uint32_t i) {
  switch (order) {
    case TriangleOrder::list:
      return {3 * i, 3 * i + 1, 3 * i + 2};
    case TriangleOrder::strip:
      return {i, i + 1 + i % 2, i + 2 - i % 2};
    case TriangleOrder::fan:
      return {i + 1, i + 2, 0};
  }
  return {};
}

/// Number of triangles. Rejects invalid numbers of corners and geometry beyond the budget.
std::uint64_t triangle_count(const PrimitiveArrays& from, const std::string& file,
                             const std::string& place, const GeometryBudget& budget) {
  const std::uint64_t stored = from.positions->count(),
                      corners = from.indices ? from.indices->count() : stored;
  const bool list = from.order == TriangleOrder::list;
  if (corners < 3 || (list && corners % 3 != 0)) {
    reject(file, place, fmt::format("{} corners", corners),
           list ? "a multiple of 3, at least 3" : "at least 3");
  }
  const std::uint64_t triangles = list ? corners / 3 : corners - 2;
  if (triangles > budget.triangles) {
    reject(file, place, fmt::format("{} more triangles", triangles),
           fmt::format("{} left of {} in all", budget.triangles, bounds::kTriangles));
  }
  const std::uint64_t split = from.normals || from.smooth ? 0 : 3 * triangles;
  if (stored > bounds::kVertices || split > budget.vertices) {
    reject(file, place, fmt::format("{} vertices", std::max(stored, split)),
           fmt::format("{} left of {} in all", budget.vertices, bounds::kVertices));
  }
  return triangles;
}

LocalVertex vertex(const PrimitiveArrays& from, std::uint32_t index) {
  LocalVertex made{vector_in(*from.positions, index), {}, {}, glm::vec4(1), index};
  if (from.normals) made.normal = vector_in(*from.normals, index);
  if (from.uvs) {
    const glm::dvec3 uv(from.uvs->finite(index, 0), from.uvs->finite(index, 1), 1);
    made.uv = glm::vec2(from.uv_transform * uv);
    if (!std::isfinite(made.uv.x) || !std::isfinite(made.uv.y)) {
      from.uvs->reject_element(index,
                               fmt::format("texture coordinates ({}, {})", made.uv.x, made.uv.y),
                               "finite numbers");
    }
  }
  for (int i = 0; from.colours && i < from.colours->components(); ++i)
    made.colour[i] = static_cast<float>(std::clamp(from.colours->finite(index, i), 0.0, 1.0));
  return made;
}

void read_triangles(const PrimitiveArrays& from, std::uint64_t count,
                    std::vector<std::uint32_t>& slots, LocalPrimitive& to) {
  const std::size_t stored = from.positions->count();
  if (slots.size() < stored) slots.resize(stored, kNoSlot);
  to.vertices.reserve(std::min<std::uint64_t>(stored, 3 * count));
  to.triangles.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::uvec3 corner = corners_of(from.order, i);
    glm::uvec3 triangle;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t source = from.indices ? from.indices->index(corner[k]) : corner[k];
      if (source >= stored)
        from.indices->reject_element(
            corner[k], fmt::format("index {}", source),
            stored == 0 ? "none without vertices" : fmt::format("0 to {}", stored - 1));
      if (slots[source] == kNoSlot) {
        slots[source] = static_cast<std::uint32_t>(to.vertices.size());
        to.vertices.push_back(vertex(from, source));
      }
      triangle[k] = slots[source];
    }
    to.triangles.push_back(triangle);
  }
  for (const LocalVertex& vertex : to.vertices) slots[vertex.source] = kNoSlot;
}

/// Copies vertices until no two triangles share one (flat normals: glTF 2.0, section 3.7.2.1).
void split(LocalPrimitive& primitive) {
  std::vector<LocalVertex> split;
  split.reserve(primitive.triangles.size() * 3);
  for (glm::uvec3& triangle : primitive.triangles) {
    for (int i = 0; i < 3; ++i) {
      split.push_back(primitive.vertices[triangle[i]]);
      triangle[i] = static_cast<std::uint32_t>(split.size() - 1);
    }
  }
  primitive.vertices = std::move(split);
}

void set_flat_normals(LocalPrimitive& primitive) {
  for (const glm::uvec3& triangle : primitive.triangles) {
    const glm::dvec3 normal = triangle_normal(primitive.vertices, triangle);
    for (int i = 0; i < 3; ++i)
      primitive.vertices[triangle[i]].normal = normal == glm::dvec3(0) ? kUp : normal;
  }
}

/// Angle of a triangle at its corner `k` [rad]; 0 if an edge has no length.
double angle_at(const std::vector<LocalVertex>& vertices, const glm::uvec3& triangle, int k) {
  const glm::dvec3& at = vertices[triangle[k]].position;
  const glm::dvec3 a = vertices[triangle[(k + 1) % 3]].position - at,
                   b = vertices[triangle[(k + 2) % 3]].position - at;
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// Means of the normals of the triangles at each vertex, weighted by their angles there (Thürmer
/// and Wüthrich 1998).
void set_smooth_normals(LocalPrimitive& primitive) {
  std::vector<LocalVertex>& vertices = primitive.vertices;
  for (LocalVertex& vertex : vertices) vertex.normal = glm::dvec3(0);
  for (const glm::uvec3& triangle : primitive.triangles) {
    const glm::dvec3 normal = triangle_normal(vertices, triangle);
    for (int k = 0; k < 3; ++k)
      vertices[triangle[k]].normal += angle_at(vertices, triangle, k) * normal;
  }
  for (LocalVertex& vertex : vertices)
    vertex.normal = glm::length(vertex.normal) < kMinNormal ? kUp : glm::normalize(vertex.normal);
}

/// Normalises stored normals; missing ones become the mean of their triangles' normals.
void normalize_stored(LocalPrimitive& primitive) {
  std::vector<bool> missing(primitive.vertices.size(), false);
  for (std::size_t i = 0; i < missing.size(); ++i) {
    glm::dvec3& normal = primitive.vertices[i].normal;
    missing[i] = glm::length(normal) < kMinNormal;
    normal = missing[i] ? glm::dvec3(0) : glm::normalize(normal);
  }
  if (std::find(missing.begin(), missing.end(), true) == missing.end()) return;
  for (const glm::uvec3& triangle : primitive.triangles) {
    for (int i = 0; i < 3; ++i) {
      if (missing[triangle[i]])
        primitive.vertices[triangle[i]].normal += triangle_normal(primitive.vertices, triangle);
    }
  }
  for (std::size_t i = 0; i < missing.size(); ++i) {
    glm::dvec3& normal = primitive.vertices[i].normal;
    if (missing[i]) normal = glm::length(normal) < kMinNormal ? kUp : glm::normalize(normal);
  }
}

void set_normals(LocalPrimitive& primitive) {
  switch (primitive.normals) {
    case Normals::stored:
      return normalize_stored(primitive);
    case Normals::flat:
      return set_flat_normals(primitive);
    case Normals::smooth:
      return set_smooth_normals(primitive);
  }
}

}  // namespace

double NumberArray::finite(std::size_t element, int component) const {
  const double value = number(element, component);
  if (!std::isfinite(value))
    reject_element(element, fmt::format("{} in component {}", value, component), "finite numbers");
  return value;
}

glm::dvec3 vector_in(const NumberArray& from, std::size_t element) {
  return {from.finite(element, 0), from.finite(element, 1), from.finite(element, 2)};
}

LocalPrimitive make_primitive(const PrimitiveArrays& arrays, const std::string& file,
                              std::string place, std::uint32_t material,
                              const GeometryBudget& budget, std::vector<std::uint32_t>& slots) {
  const std::uint64_t triangles = triangle_count(arrays, file, place, budget);
  LocalPrimitive made;
  made.place = std::move(place);
  made.material = material;
  made.normals = arrays.normals ? Normals::stored : arrays.smooth ? Normals::smooth : Normals::flat;
  read_triangles(arrays, triangles, slots, made);
  if (made.normals == Normals::flat) split(made);
  set_normals(made);
  return made;
}

void move_vertices(LocalPrimitive& primitive, const NumberArray& positions,
                   const NumberArray* normals) {
  for (LocalVertex& vertex : primitive.vertices) {
    vertex.position = vector_in(positions, vertex.source);
    if (normals) vertex.normal = vector_in(*normals, vertex.source);
  }
  if (normals || primitive.normals != Normals::stored) set_normals(primitive);
}

}  // namespace clpv
