// SPDX-License-Identifier: MIT
// Meshes of a model in local space, their instances at nodes, and their animation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/node_tree.hpp"
#include "scene/scene.hpp"

namespace clpv {

struct LocalVertex {
  glm::dvec3 position, normal;
  glm::vec2 uv;
  glm::vec4 colour;
  std::uint32_t source;  ///< index in the accessors, for messages
};

/// Joints that move a vertex, with weights of sum 1.
struct Influence {
  std::uint16_t joints[4];
  double weights[4];
};

/// Offsets of a morph target at weight 1: one per vertex, or empty.
struct MorphTarget {
  std::vector<glm::vec3> positions, normals;
};

/// Where normals come from: given; of each triangle, whose vertices no other shares; means of
/// triangles, weighted by angle.
enum class Normals { stored, flat, smooth };

struct LocalPrimitive {
  std::string place;  ///< "/meshes/3/primitives/0"
  std::vector<LocalVertex> vertices;
  std::vector<glm::uvec3> triangles;
  std::uint32_t material = 0;
  Normals normals = Normals::stored;
  std::vector<Influence> influences;  ///< one per vertex; empty without joints
  std::vector<MorphTarget> targets;
};

/// Unit normal of a triangle; 0 if its area is 0.
glm::dvec3 triangle_normal(const std::vector<LocalVertex>& vertices, const glm::uvec3& triangle);

/// A primitive at a node, and the range of the scene's vertices and triangles that it fills.
struct Instance {
  std::shared_ptr<const LocalPrimitive> primitive;
  std::size_t node = 0;               ///< index in the tree
  std::optional<glm::dmat4> to_node;  ///< to the node's space, of an instance in that node
  std::shared_ptr<const Skin> skin;   ///< null: the node's transform applies
  std::vector<double> weights;        ///< weights of morph targets without a curve
  /// In the scene, whose vectors have their final size.
  std::uint32_t first_vertex = 0, first_triangle = 0;
};

/// Range of the scene's vertices and triangles that an instance fills.
MeshRange range_of(const Instance& instance);

/// Returns true if the instance is animated.
bool moves(const Instance& instance, const NodeTree& tree);

/// Reserves memory for more instances of a primitive, with geometric growth. Throws
/// Error(bad_input) with `file` and the primitive's place for more geometry than the bounds allow.
void reserve(SceneData& scene, const LocalPrimitive& primitive, std::size_t count,
             const std::string& file);

/// Appends an instance to the scene, and sets the range that it fills. Throws as place().
void append(Instance& instance, PosedTree& posed, SceneData& scene);

/// Writes the vertices [m] and triangles of an instance into the scene, transformed by morph
/// targets, then skin or node. Mirrored instances keep their fronts outside. Throws
/// Error(bad_input) for coordinates beyond the bounds.
void place(const Instance& instance, PosedTree& posed, SceneData& scene);

/// Sets eye, forward (the node's -z) and up. Messages contain `file` and the node's index. Throws
/// Error(bad_input) for coordinates beyond the bounds and for transforms that map the direction to
/// 0.
void place_camera(SceneCamera& camera, const glm::dmat4& to_world, const std::string& file,
                  int node);

/// Sets position and direction (the node's -z; not for point lights). Throws as place_camera().
void place_light(ClpvLight& light, const glm::dmat4& to_world, const std::string& file, int node);

/// Animated meshes, cameras and lights of a model.
struct Motion {
  /// A camera or light at a moving node.
  struct MovingView {
    std::size_t view;  ///< index in the scene's cameras or lights
    std::size_t node;  ///< index in `tree`
  };

  NodeTree tree;
  std::vector<Instance> meshes;
  std::vector<MovingView> cameras, lights;

  bool empty() const { return meshes.empty() && cameras.empty() && lights.empty(); }

  /// Poses the scene at a time [s], independently of its pose before. Throws Error(bad_input) if
  /// values leave their bounds.
  void pose(SceneData& scene, double seconds) const;
};

}  // namespace clpv
