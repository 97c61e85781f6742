// SPDX-License-Identifier: MIT
// Meshes of a model in local space, their instances at nodes, and their animation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/scene.hpp"
#include "support/named_enum.hpp"

namespace clpv {

// Keyframe curves: quantities that change with time (glTF 2.0, appendix C), in double.

/// Interpolation between keys, with glTF's names.
enum class Interpolation : unsigned {
  linear,        ///< linear; rotations and directions spherically, along the shorter great circle
  step,          ///< constant until the next key
  cubic_spline,  ///< cubic Hermite spline by values and tangents
};

template <>
inline constexpr auto kNames<Interpolation> = name_list("LINEAR", "STEP", "CUBICSPLINE");

/// A curve is constant before its first key and after its last.
struct Curve {
  Interpolation interpolation = Interpolation::linear;
  std::size_t components = 1;
  std::vector<double> times;  ///< [s], at least one, strictly rising
  /// `components` numbers per key. A cubic spline has three times as many: in-tangent [1/s], value,
  /// out-tangent [1/s] (glTF 2.0, appendix C.5).
  std::vector<double> values;
};

/// Evaluates each component independently into `out`, of size `components`.
void evaluate(const Curve& curve, double seconds, std::span<double> out);

/// Evaluates a curve of three components.
glm::dvec3 vector_at(const Curve& curve, double seconds);

/// Evaluates a curve of unit vectors by spherical interpolation. Adjacent keys must not be
/// opposite. Not for cubic splines.
glm::dvec3 direction_at(const Curve& curve, double seconds);

/// Evaluates a curve of unit quaternions x, y, z, w by spherical interpolation along the shorter
/// arc. Cubic splines are normalised, unless their length is 0.
glm::dquat rotation_at(const Curve& curve, double seconds);

// Node tree and skins of a model, and their transforms at a time. Independent of the document.

/// Translation, rotation and scale, applied in the order scale, rotation, translation.
struct Pose {
  std::optional<glm::dvec3> translation, scale;
  std::optional<glm::dquat> rotation;  ///< unit
  glm::dmat4 matrix() const;
};

/// Animation curves of a node; null for properties without one.
struct NodeCurves {
  std::shared_ptr<const Curve> translation, rotation, scale;
  std::shared_ptr<const Curve> weights;  ///< weights of the mesh's morph targets
  bool moves() const { return translation || rotation || scale; }
};

struct TreeNode {
  int index = 0;                      ///< in the document; below 0: of a mesh in memory
  std::optional<std::size_t> parent;  ///< position in NodeTree::nodes; parents come first
  glm::dmat4 rest{1.0};               ///< transform to the parent's space, without curves
  Pose pose;                          ///< values of properties without a curve, for animated nodes
  NodeCurves curves;
  bool moves = false;  ///< true if the node or an ancestor is animated
};

/// "/nodes/3" for messages; "transform" of a mesh in memory.
std::string place_of(const TreeNode& node);

struct NodeTree {
  std::string file;  ///< for messages
  glm::dmat4 root{1.0};
  std::vector<TreeNode> nodes;

  /// Transforms of all nodes to world space, in order. Throws Error(bad_input) for transforms that
  /// are not finite, and for splines of rotations with a length below 0.5.
  std::vector<glm::dmat4> to_world(double seconds) const;
};

struct Skin {
  std::vector<std::size_t> joints;  ///< positions in NodeTree::nodes
  /// One per joint: from the mesh's space to the joint's space.
  std::vector<glm::dmat4> inverse_binds;
};

/// A tree at a time: transforms of nodes and of joints. Borrows the tree.
class PosedTree {
 public:
  /// Throws as NodeTree::to_world().
  PosedTree(const NodeTree& tree, double seconds)
      : tree_(tree), seconds_(seconds), to_world_(tree.to_world(seconds)) {}

  const NodeTree& tree() const { return tree_; }
  double seconds() const { return seconds_; }
  const glm::dmat4& to_world(std::size_t node) const { return to_world_[node]; }

  /// Transform of a camera or light, which ignores its node's scale (glTF 2.0, section 3.10.2):
  /// to_world() as if no number of that scale were negative. Their axes have no lengths.
  glm::dmat4 unmirrored(std::size_t node) const;

  /// Joint matrices of a skin, one per joint, from the mesh's space to world space.
  std::span<const glm::dmat4> joints(const Skin& skin);

 private:
  const NodeTree& tree_;
  double seconds_;
  std::vector<glm::dmat4> to_world_;
  std::map<const Skin*, std::vector<glm::dmat4>> joints_;
};

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
