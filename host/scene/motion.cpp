// SPDX-License-Identifier: MIT
#include "scene/motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>

#include "scene/bounds.hpp"
#include "scene/light_kind.hpp"
#include "support/error.hpp"

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

/// The primitive's vertices, each target added by its weight; normals unit, flat ones by their triangles anew.
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

/// What a vertex goes with: its joints' matrices by their shares.
glm::dmat4 blended(const Influence& influence, std::span<const glm::dmat4> joints) {
  glm::dmat4 sum(0.0);
  for (int i = 0; i < 4; ++i) {
    if (influence.weights[i] > 0) sum += influence.weights[i] * joints[influence.joints[i]];
  }
  return sum;
}

/// What turns normals: the cofactors of M are det(M) times its inverse transpose, so they need no division
/// and work for flattened nodes too; the determinant's sign undoes the flip of a mirrored one.
glm::dmat3 normal_matrix(const glm::dmat3& m) {
  const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  return glm::determinant(m) < 0 ? -cofactors : cofactors;
}

/// Where vertices go: one matrix for all of them, or one each.
struct Placement {
  glm::dmat4 to_world{1.0};
  std::span<const glm::dmat4> joints;  ///< of a skin
  glm::dmat4 of(const LocalPrimitive& primitive, std::size_t vertex) const {
    return joints.empty() ? to_world : blended(primitive.influences[vertex], joints);
  }
};

Placement placement_of(const Instance& instance, PosedTree& posed) {
  if (!instance.skin || instance.primitive->influences.empty()) return {posed.to_world(instance.node), {}};
  Placement made{glm::dmat4(1.0), posed.joints(*instance.skin)};
  made.to_world = made.of(*instance.primitive, 0);  // tells whether it is mirrored
  return made;
}

/// Of its morph targets at an instant.
std::vector<double> weights_of(const Instance& instance, const PosedTree& posed) {
  const auto& curve = posed.tree().nodes[instance.node].curves.weights;
  std::vector<double> weights = instance.weights;
  if (curve) evaluate(*curve, posed.seconds(), weights);
  return weights;
}

Vertex placed(const LocalVertex& local, const glm::dmat4& to_world, const glm::dmat3& to_normal,
              const Instance& instance, const NodeTree& tree) {
  const glm::dvec3 p(to_world * glm::dvec4(local.position, 1));
  for (int i = 0; i < 3; ++i) {
    if (!(std::abs(p[i]) <= bounds::kCoordinate)) {
      reject(tree.file, instance.primitive->place,
             fmt::format("vertex {} at ({}, {}, {}) m, placed by /nodes/{}", local.source, p.x, p.y, p.z,
                         tree.nodes[instance.node].index),
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

void place_vertices(const Instance& instance, const std::vector<LocalVertex>& vertices,
                    const Placement& placement, const NodeTree& tree, Scene& scene) {
  glm::dmat4 to_world = placement.to_world;
  glm::dmat3 to_normal = normal_matrix(glm::dmat3(to_world));
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (!placement.joints.empty()) {
      to_world = placement.of(*instance.primitive, i);
      to_normal = normal_matrix(glm::dmat3(to_world));
    }
    scene.vertices[instance.first_vertex + i] = placed(vertices[i], to_world, to_normal, instance, tree);
  }
}

void place_triangles(const Instance& instance, bool mirrored, Scene& scene) {
  const std::uint32_t base = instance.first_vertex;
  Triangle* triangle = scene.triangles.data() + instance.first_triangle;
  for (const glm::uvec3& t : instance.primitive->triangles) {
    const std::uint32_t second = base + (mirrored ? t.z : t.y), third = base + (mirrored ? t.y : t.z);
    *triangle++ = {{base + t.x, second, third}, instance.primitive->material};
  }
}

/// A node's transform, and what to call it.
struct NodePlace {
  const glm::dmat4& to_world;
  const std::string& file;
  std::string node;
};

void store(float (&to)[3], const glm::vec3& from) {
  std::copy_n(glm::value_ptr(from), 3, to);
}

glm::vec3 position(const NodePlace& place) {
  const glm::dvec3 p(place.to_world[3]);
  if (glm::any(glm::greaterThan(glm::abs(p), glm::dvec3(bounds::kCoordinate)))) {
    reject(place.file, place.node, fmt::format("({}, {}, {}) m", p.x, p.y, p.z),
           fmt::format("coordinates within +-{} m", bounds::kCoordinate));
  }
  return glm::vec3(p);
}

glm::vec3 axis(const NodePlace& place, const glm::dvec3& local, const char* what) {
  const glm::dvec3 direction = glm::dmat3(place.to_world) * local;
  const double length = glm::length(direction);
  if (!(length > 0) || !std::isfinite(length)) {
    reject(place.file, place.node + what, "a transform that leaves no direction", "scales other than 0");
  }
  return glm::vec3(direction / length);
}

}  // namespace

glm::dvec3 triangle_normal(const std::vector<LocalVertex>& vertices, const glm::uvec3& t) {
  const glm::dvec3& a = vertices[t.x].position;
  const glm::dvec3 n = glm::cross(vertices[t.y].position - a, vertices[t.z].position - a);
  const double length = glm::length(n);
  return length > 0 && std::isfinite(length) ? n / length : glm::dvec3(0);
}

bool moves(const Instance& instance, const NodeTree& tree) {
  const TreeNode& node = tree.nodes[instance.node];
  if (node.curves.weights && !instance.primitive->targets.empty()) return true;
  if (!instance.skin || instance.primitive->influences.empty()) return node.moves;
  const std::vector<std::size_t>& joints = instance.skin->joints;
  return std::any_of(joints.begin(), joints.end(),
                     [&](std::size_t joint) { return tree.nodes[joint].moves; });
}

void place(const Instance& instance, PosedTree& posed, Scene& scene) {
  const Placement placement = placement_of(instance, posed);
  const LocalPrimitive& primitive = *instance.primitive;
  if (primitive.targets.empty()) {
    place_vertices(instance, primitive.vertices, placement, posed.tree(), scene);
  } else {
    place_vertices(instance, morphed(primitive, weights_of(instance, posed)), placement, posed.tree(), scene);
  }
  place_triangles(instance, glm::determinant(glm::dmat3(placement.to_world)) < 0, scene);
}

void place_camera(Camera& camera, const glm::dmat4& to_world, const std::string& file, int node) {
  const NodePlace place{to_world, file, fmt::format("/nodes/{}", node)};
  camera.eye = position(place);
  camera.forward = axis(place, {0, 0, -1}, "/camera");
  const glm::dvec3 up(axis(place, {0, 1, 0}, "/camera")), forward(camera.forward);
  const glm::dvec3 across = up - forward * glm::dot(forward, up);  // a sheared node tilts it
  if (glm::length(across) < 1e-6)
    reject(file, place.node, "a camera's transform without up", "up across forward");
  camera.up = glm::vec3(glm::normalize(across));
}

void place_light(ClpvLight& light, const glm::dmat4& to_world, const std::string& file, int node) {
  const NodePlace place{to_world, file, fmt::format("/nodes/{}", node)};
  store(light.position, position(place));
  if (kind_of(light) != LightKind::point)
    store(light.direction, axis(place, {0, 0, -1}, "/extensions/KHR_lights_punctual"));
}

void Motion::pose(Scene& scene, double seconds) const {
  if (empty()) return;
  PosedTree posed(tree, seconds);
  for (const Instance& instance : meshes) place(instance, posed, scene);
  for (const MovingView& each : cameras) {
    place_camera(scene.cameras[each.view], posed.to_world(each.node), tree.file, tree.nodes[each.node].index);
  }
  for (const MovingView& each : lights) {
    place_light(scene.lights[each.view].data, posed.to_world(each.node), tree.file,
                tree.nodes[each.node].index);
  }
}

}  // namespace clpv
