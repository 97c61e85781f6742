// SPDX-License-Identifier: MIT
#include "scene/instance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/bounds.hpp"
#include "scene/deform.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

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

class Placer {
 public:
  Placer(const Instance& instance, const NodeTree& tree) : instance_(instance), tree_(tree) {}

  Vertex placed(const LocalVertex& local, const glm::dmat4& to_world, const glm::dmat3& to_normal) const {
    const glm::dvec3 p(to_world * glm::dvec4(local.position, 1));
    for (int i = 0; i < 3; ++i) {
      if (!(std::abs(p[i]) <= bounds::kCoordinate)) {
        refuse(tree_.file, instance_.primitive->place,
               fmt::format("vertex {} at ({}, {}, {}) m, placed by /nodes/{}", local.source, p.x, p.y, p.z,
                           tree_.nodes[instance_.node].index),
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

 private:
  const Instance& instance_;
  const NodeTree& tree_;
};

void place_vertices(const Instance& instance, const std::vector<LocalVertex>& vertices,
                    const Placement& placement, const NodeTree& tree, Scene& scene) {
  const Placer placer(instance, tree);
  glm::dmat4 to_world = placement.to_world;
  glm::dmat3 to_normal = normal_matrix(glm::dmat3(to_world));
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (!placement.joints.empty()) {
      to_world = placement.of(*instance.primitive, i);
      to_normal = normal_matrix(glm::dmat3(to_world));
    }
    scene.vertices[instance.first_vertex + i] = placer.placed(vertices[i], to_world, to_normal);
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

}  // namespace

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

}  // namespace clpv
