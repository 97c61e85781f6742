// SPDX-License-Identifier: MIT
// The meshes of a model: primitives in their own space, the nodes at which they stand, and what of that moves.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "scene/node_tree.hpp"
#include "scene/scene.hpp"

namespace clpv {

struct LocalVertex {
  glm::dvec3 position, normal;
  glm::vec2 uv;
  glm::vec4 colour;
  std::uint32_t source;  ///< its index in the accessors, for messages
};

/// What joints of a skin a vertex goes with, and their shares, which add up to 1.
struct Influence {
  std::uint16_t joints[4];
  double weights[4];
};

/// What a morph target adds at weight 1: one a vertex, or none.
struct MorphTarget {
  std::vector<glm::vec3> positions, normals;
};

struct LocalPrimitive {
  std::string place;  ///< "/meshes/3/primitives/0"
  std::vector<LocalVertex> vertices;
  std::vector<glm::uvec3> triangles;
  std::uint32_t material = 0;
  bool flat = false;                  ///< without stored normals: each triangle has three vertices of its own
  std::vector<Influence> influences;  ///< one a vertex; none: it has no joints
  std::vector<MorphTarget> targets;
};

/// The unit normal of a triangle of those vertices; 0 of one without area.
glm::dvec3 triangle_normal(const std::vector<LocalVertex>& vertices, const glm::uvec3& triangle);

/// A primitive that stands at a node: its vertices and triangles in world space, and their places in the scene.
struct Instance {
  std::shared_ptr<const LocalPrimitive> primitive;
  std::size_t node = 0;                                ///< of the tree
  std::shared_ptr<const Skin> skin;                    ///< null: it goes with its node
  std::vector<double> weights;                         ///< of morph targets, where no curve says them
  std::uint32_t first_vertex = 0, first_triangle = 0;  ///< in the scene, which has room for all from there on
};

/// Whether it changes with time.
bool moves(const Instance& instance, const NodeTree& tree);

/// Writes its vertices [m] and triangles into the scene: bent by its morph targets and its skin, or placed by its node; a
/// mirrored one keeps its outside outside. Throws Error(bad_input) for coordinates beyond the bounds.
void place(const Instance& instance, PosedTree& posed, Scene& scene);

/// Sets eye, forward and up: it looks along the node's -z. `file` and `node`, its index, are for messages. Throws
/// Error(bad_input) for coordinates beyond the bounds and transforms that leave no direction; so does place_light.
void place_camera(Camera& camera, const glm::dmat4& to_world, const std::string& file, int node);

/// Sets position, and the direction of what has one: along the node's -z.
void place_light(ClpvLight& light, const glm::dmat4& to_world, const std::string& file, int node);

/// What of a model moves, and how.
struct Motion {
  /// A camera or a light at a node that moves.
  struct MovingView {
    std::size_t view;  ///< in the scene's cameras, or its lights
    std::size_t node;  ///< in `tree`
  };

  NodeTree tree;
  std::vector<Instance> meshes;
  std::vector<MovingView> cameras, lights;

  bool empty() const { return meshes.empty() && cameras.empty() && lights.empty(); }

  /// Puts all that moves where it is at an instant [s], whatever instant the scene showed before. Throws Error(bad_input)
  /// for what leads out of the bounds.
  void pose(Scene& scene, double seconds) const;
};

}  // namespace clpv
