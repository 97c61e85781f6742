// SPDX-License-Identifier: MIT
// Poses meshes, cameras and lights: morph targets, skinning and node transforms (glTF 2.0, section
// 3.7).

#include "scene/motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "scene/bounds.hpp"
#include "scene/scene.hpp"
#include "support/error.hpp"

namespace clpv {

// Evaluates keyframe curves.

namespace {

/// The interval between two keys that contains an instant.
struct KeyInterval {
  /// Key at the start of the interval, or the first or last key outside all intervals.
  std::size_t key;
  double fraction = 0;  ///< position in the interval, in [0, 1); 0 outside
  double duration = 0;  ///< [s]
};

KeyInterval interval_at(const Curve& curve, double seconds) {
  const auto after = std::upper_bound(curve.times.begin(), curve.times.end(), seconds);
  if (after == curve.times.begin()) return {0};
  const auto key = static_cast<std::size_t>(after - curve.times.begin()) - 1;
  if (after == curve.times.end()) return {key};
  const double duration = *after - curve.times[key];
  return {key, (seconds - curve.times[key]) / duration, duration};
}

/// Numbers of a key. In a cubic spline, `part` is 0 for the in-tangent, 1 for the value, 2 for the
/// out-tangent.
const double* key_of(const Curve& curve, std::size_t key, std::size_t part = 1) {
  const bool cubic = curve.interpolation == Interpolation::cubic_spline;
  return &curve.values[(cubic ? 3 * key + part : key) * curve.components];
}

void hermite(const Curve& curve, const KeyInterval& at, std::span<double> out) {
  const double t = at.fraction, t2 = t * t, t3 = t2 * t;
  const double* from = key_of(curve, at.key);
  const double* out_tangent = key_of(curve, at.key, 2);
  const double* to = key_of(curve, at.key + 1);
  const double* in_tangent = key_of(curve, at.key + 1, 0);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = (2 * t3 - 3 * t2 + 1) * from[i] + at.duration * (t3 - 2 * t2 + t) * out_tangent[i] +
             (3 * t2 - 2 * t3) * to[i] + at.duration * (t3 - t2) * in_tangent[i];
  }
}

glm::dvec3 vector_of(const double* v) {
  return {v[0], v[1], v[2]};
}

glm::dquat rotation_of(const double* v) {
  return {v[3], v[0], v[1], v[2]};
}

}  // namespace

void evaluate(const Curve& curve, double seconds, std::span<double> out) {
  const KeyInterval at = interval_at(curve, seconds);
  const double* from = key_of(curve, at.key);
  if (at.fraction == 0 || curve.interpolation == Interpolation::step) {
    std::copy_n(from, out.size(), out.begin());
  } else if (curve.interpolation == Interpolation::cubic_spline) {
    hermite(curve, at, out);
  } else {
    const double* to = key_of(curve, at.key + 1);
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = (1 - at.fraction) * from[i] + at.fraction * to[i];
  }
}

glm::dvec3 vector_at(const Curve& curve, double seconds) {
  double v[3];
  evaluate(curve, seconds, v);
  return vector_of(v);
}

glm::dvec3 direction_at(const Curve& curve, double seconds) {
  const KeyInterval at = interval_at(curve, seconds);
  const glm::dvec3 from = vector_of(key_of(curve, at.key));
  if (at.fraction == 0 || curve.interpolation == Interpolation::step) return from;
  const glm::dvec3 to = vector_of(key_of(curve, at.key + 1));
  const double angle = std::atan2(glm::length(glm::cross(from, to)), glm::dot(from, to));
  if (angle < 1e-9) return from;  // equal up to rounding
  return glm::normalize(std::sin((1 - at.fraction) * angle) * from +
                        std::sin(at.fraction * angle) * to);
}

glm::dquat rotation_at(const Curve& curve, double seconds) {
  const KeyInterval at = interval_at(curve, seconds);
  if (at.fraction > 0 && curve.interpolation == Interpolation::linear) {
    const glm::dquat from = rotation_of(key_of(curve, at.key)),
                     to = rotation_of(key_of(curve, at.key + 1));
    return glm::normalize(glm::slerp(from, to, at.fraction));
  }
  double v[4];
  evaluate(curve, seconds, v);
  const glm::dquat rotation = rotation_of(v);
  const double length = glm::length(rotation);
  return length > 0 ? rotation / length : rotation;
}

// Evaluates transforms of nodes and joints.

namespace {

bool finite(const glm::dmat4& m) {
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      if (!std::isfinite(m[column][row])) return false;
    }
  }
  return true;
}

/// Pose of an animated node.
Pose pose_at(const NodeTree& tree, const TreeNode& node, double seconds) {
  Pose pose = node.pose;
  if (node.curves.translation) pose.translation = vector_at(*node.curves.translation, seconds);
  if (node.curves.scale) pose.scale = vector_at(*node.curves.scale, seconds);
  if (node.curves.rotation) {
    pose.rotation = rotation_at(*node.curves.rotation, seconds);
    if (!(glm::length(*pose.rotation) > 0.5)) {
      reject(tree.file, fmt::format("/nodes/{}/rotation", node.index),
             fmt::format("a quaternion of length {} at {} s", glm::length(*pose.rotation), seconds),
             "splines through lengths above 0.5");
    }
  }
  return pose;
}

}  // namespace

std::string place_of(const TreeNode& node) {
  return node.index < 0 ? "transform" : fmt::format("/nodes/{}", node.index);
}

glm::dmat4 Pose::matrix() const {
  glm::dmat4 transform(1.0);
  if (translation) transform = glm::translate(transform, *translation);
  if (rotation) transform *= glm::mat4_cast(*rotation);
  if (scale) transform = glm::scale(transform, *scale);
  return transform;
}

std::vector<glm::dmat4> NodeTree::to_world(double seconds) const {
  std::vector<glm::dmat4> made;
  made.reserve(nodes.size());
  for (const TreeNode& node : nodes) {
    const glm::dmat4& parent = node.parent ? made[*node.parent] : root;
    made.push_back(parent *
                   (node.curves.moves() ? pose_at(*this, node, seconds).matrix() : node.rest));
    if (!finite(made.back())) {
      reject(file, place_of(node), "a transform that overflows", "finite transforms");
    }
  }
  return made;
}

glm::dmat4 PosedTree::unmirrored(std::size_t index) const {
  const TreeNode& node = tree_.nodes[index];
  Pose pose = pose_at(tree_, node, seconds_);
  if (!pose.scale || !glm::any(glm::lessThan(*pose.scale, glm::dvec3(0)))) return to_world_[index];
  pose.scale = glm::abs(*pose.scale);
  return (node.parent ? to_world_[*node.parent] : tree_.root) * pose.matrix();
}

std::span<const glm::dmat4> PosedTree::joints(const Skin& skin) {
  std::vector<glm::dmat4>& matrices = joints_[&skin];
  if (matrices.empty()) {
    for (std::size_t i = 0; i < skin.joints.size(); ++i)
      matrices.push_back(to_world_[skin.joints[i]] * skin.inverse_binds[i]);
  }
  return matrices;
}

namespace {

// Shorter morphed normals are replaced by the stored ones.
constexpr double kMinMorphedNormal = 1e-6;

void add_target(const MorphTarget& target, double weight, std::vector<LocalVertex>& vertices) {
  if (weight == 0) return;
  for (std::size_t i = 0; i < target.positions.size(); ++i)
    vertices[i].position += weight * glm::dvec3(target.positions[i]);
  for (std::size_t i = 0; i < target.normals.size(); ++i)
    vertices[i].normal += weight * glm::dvec3(target.normals[i]);
}

/// Vertices plus the weighted morph targets. Normals are normalised; flat ones are recomputed from
/// the triangles.
std::vector<LocalVertex> morphed(const LocalPrimitive& primitive, std::span<const double> weights) {
  std::vector<LocalVertex> vertices = primitive.vertices;
  for (std::size_t t = 0; t < primitive.targets.size(); ++t)
    add_target(primitive.targets[t], weights[t], vertices);
  if (primitive.normals == Normals::flat) {
    for (const glm::uvec3& t : primitive.triangles) {
      const glm::dvec3 normal = triangle_normal(vertices, t);
      for (int i = 0; i < 3 && normal != glm::dvec3(0); ++i) vertices[t[i]].normal = normal;
    }
    return vertices;
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    glm::dvec3& normal = vertices[i].normal;
    normal = glm::length(normal) < kMinMorphedNormal ? primitive.vertices[i].normal
                                                     : glm::normalize(normal);
  }
  return vertices;
}

/// Weighted sum of the joints' matrices.
glm::dmat4 blended(const Influence& influence, std::span<const glm::dmat4> joints) {
  glm::dmat4 sum(0.0);
  for (int i = 0; i < 4; ++i) {
    if (influence.weights[i] > 0) sum += influence.weights[i] * joints[influence.joints[i]];
  }
  return sum;
}

/// Transform of normals: the cofactor matrix of m, which is det(m) times the inverse transpose and
/// exists for singular m too. The sign of the determinant corrects mirroring.
glm::dmat3 normal_matrix(const glm::dmat3& m) {
  const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]),
                             glm::cross(m[0], m[1]));
  return glm::determinant(m) < 0 ? -cofactors : cofactors;
}

/// Transform of an instance's vertices: one matrix, or one per vertex from the joints of a skin.
struct Placement {
  glm::dmat4 to_world{1.0};
  std::span<const glm::dmat4> joints;  ///< empty without a skin
  glm::dmat4 of(const LocalPrimitive& primitive, std::size_t vertex) const {
    return joints.empty() ? to_world : blended(primitive.influences[vertex], joints);
  }
};

Placement placement_of(const Instance& instance, PosedTree& posed) {
  if (!instance.skin || instance.primitive->influences.empty())
    return {instance.to_node ? posed.to_world(instance.node) * *instance.to_node
                             : posed.to_world(instance.node),
            {}};
  return {glm::dmat4(1.0), posed.joints(*instance.skin)};
}

/// Weights of the instance's morph targets at the time of the pose.
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
             fmt::format("vertex {} at ({}, {}, {}) m, placed by {}", local.source, p.x, p.y, p.z,
                         place_of(tree.nodes[instance.node])),
             fmt::format("coordinates within +-{} m", bounds::kCoordinate));
    }
  }
  glm::dvec3 n = to_normal * local.normal;
  const double length = glm::length(n);
  n = length > 0 && std::isfinite(length) ? n / length : local.normal;  // 0 for scales of 0
  const auto f = [](double value) { return static_cast<float>(value); };
  return {{f(p.x), f(p.y), f(p.z)},
          {f(n.x), f(n.y), f(n.z)},
          {local.uv.x, local.uv.y},
          {local.colour.x, local.colour.y, local.colour.z, local.colour.w}};
}

/// Returns for each vertex whether its transform mirrors.
std::vector<bool> place_vertices(const Instance& instance, const std::vector<LocalVertex>& vertices,
                                 const Placement& placement, const NodeTree& tree,
                                 SceneData& scene) {
  glm::dmat4 to_world = placement.to_world;
  glm::dmat3 to_normal = normal_matrix(glm::dmat3(to_world));
  std::vector<bool> mirrored(vertices.size(), glm::determinant(glm::dmat3(to_world)) < 0);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (!placement.joints.empty()) {
      to_world = placement.of(*instance.primitive, i);
      to_normal = normal_matrix(glm::dmat3(to_world));
      mirrored[i] = glm::determinant(glm::dmat3(to_world)) < 0;
    }
    scene.vertices[instance.first_vertex + i] =
        placed(vertices[i], to_world, to_normal, instance, tree);
  }
  return mirrored;
}

/// Turns triangles over of which most vertices are mirrored, so that their fronts stay outside.
void place_triangles(const Instance& instance, const std::vector<bool>& mirrored,
                     SceneData& scene) {
  const std::uint32_t base = instance.first_vertex;
  Triangle* triangle = scene.triangles.data() + instance.first_triangle;
  for (const glm::uvec3& t : instance.primitive->triangles) {
    const bool turned = mirrored[t.x] + mirrored[t.y] + mirrored[t.z] >= 2;
    const std::uint32_t second = base + (turned ? t.z : t.y), third = base + (turned ? t.y : t.z);
    *triangle++ = {{base + t.x, second, third}, instance.primitive->material};
  }
}

/// Reserves with geometric growth: an exact reserve for each primitive would copy all vertices each
/// time.
template <typename T>
void grow(std::vector<T>& values, std::uint64_t size) {
  if (size > values.capacity()) values.reserve(std::max<std::size_t>(size, 2 * values.capacity()));
}

/// A node's transform, and its file and JSON pointer for messages.
struct NodeTransform {
  const glm::dmat4& to_world;
  const std::string& file;
  std::string place;
};

void store(float (&to)[3], const glm::vec3& from) {
  std::copy_n(glm::value_ptr(from), 3, to);
}

glm::vec3 position(const NodeTransform& node) {
  const glm::dvec3 p(node.to_world[3]);
  if (glm::any(glm::greaterThan(glm::abs(p), glm::dvec3(bounds::kCoordinate)))) {
    reject(node.file, node.place, fmt::format("({}, {}, {}) m", p.x, p.y, p.z),
           fmt::format("coordinates within +-{} m", bounds::kCoordinate));
  }
  return glm::vec3(p);
}

/// Unit direction of a local axis in world space; `member` is the part of the node for messages.
glm::vec3 axis(const NodeTransform& node, const glm::dvec3& local, const char* member) {
  const glm::dvec3 direction = glm::dmat3(node.to_world) * local;
  const double length = glm::length(direction);
  if (!(length > 0) || !std::isfinite(length)) {
    reject(node.file, node.place + member, "a transform that leaves no direction",
           "scales other than 0");
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

MeshRange range_of(const Instance& instance) {
  return {instance.first_vertex, static_cast<std::uint32_t>(instance.primitive->vertices.size()),
          instance.first_triangle,
          static_cast<std::uint32_t>(instance.primitive->triangles.size())};
}

void reserve(SceneData& scene, const LocalPrimitive& primitive, std::size_t count,
             const std::string& file) {
  const std::uint64_t vertices = scene.vertices.size() + count * primitive.vertices.size();
  const std::uint64_t triangles = scene.triangles.size() + count * primitive.triangles.size();
  if (vertices > bounds::kVertices || triangles > bounds::kTriangles) {
    reject(file, primitive.place,
           fmt::format("{} vertices and {} triangles so far, with this primitive at {} places",
                       vertices, triangles, count),
           fmt::format("at most {} and {} in all", bounds::kVertices, bounds::kTriangles));
  }
  grow(scene.vertices, vertices);
  grow(scene.triangles, triangles);
}

void append(Instance& instance, PosedTree& posed, SceneData& scene) {
  const LocalPrimitive& primitive = *instance.primitive;
  instance.first_vertex = static_cast<std::uint32_t>(scene.vertices.size());
  instance.first_triangle = static_cast<std::uint32_t>(scene.triangles.size());
  scene.vertices.resize(scene.vertices.size() + primitive.vertices.size());
  scene.triangles.resize(scene.triangles.size() + primitive.triangles.size());
  place(instance, posed, scene);
}

void place(const Instance& instance, PosedTree& posed, SceneData& scene) {
  const Placement placement = placement_of(instance, posed);
  const LocalPrimitive& primitive = *instance.primitive;
  const auto place_all = [&](const std::vector<LocalVertex>& vertices) {
    place_triangles(instance, place_vertices(instance, vertices, placement, posed.tree(), scene),
                    scene);
  };
  if (primitive.targets.empty())
    place_all(primitive.vertices);
  else
    place_all(morphed(primitive, weights_of(instance, posed)));
}

void place_camera(SceneCamera& camera, const glm::dmat4& to_world, const std::string& file,
                  int node) {
  const NodeTransform transform{to_world, file, fmt::format("/nodes/{}", node)};
  camera.eye = position(transform);
  camera.forward = axis(transform, {0, 0, -1}, "/camera");
  const glm::dvec3 up(axis(transform, {0, 1, 0}, "/camera")), forward(camera.forward);
  // Shear makes them oblique.
  const glm::dvec3 perpendicular = up - forward * glm::dot(forward, up);
  if (glm::length(perpendicular) < 1e-6)
    reject(file, transform.place, "a camera's transform with parallel up and forward",
           "different directions");
  camera.up = glm::vec3(glm::normalize(perpendicular));
}

void place_light(ClpvLight& light, const glm::dmat4& to_world, const std::string& file, int node) {
  const NodeTransform transform{to_world, file, fmt::format("/nodes/{}", node)};
  store(light.position, position(transform));
  if (kind_of(light) != LightKind::point)
    store(light.direction, axis(transform, {0, 0, -1}, "/extensions/KHR_lights_punctual"));
}

void Motion::pose(SceneData& scene, double seconds) const {
  if (empty()) return;
  PosedTree posed(tree, seconds);
  for (const Instance& instance : meshes) place(instance, posed, scene);
  for (const MovingView& each : cameras) {
    place_camera(scene.cameras[each.view], posed.unmirrored(each.node), tree.file,
                 tree.nodes[each.node].index);
  }
  for (const MovingView& each : lights) {
    place_light(scene.lights[each.view].data, posed.unmirrored(each.node), tree.file,
                tree.nodes[each.node].index);
  }
}

}  // namespace clpv
