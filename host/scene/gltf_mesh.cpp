// SPDX-License-Identifier: MIT
#include "scene/gltf_mesh.hpp"

#include <algorithm>
#include <map>

#include "scene/bounds.hpp"
#include "scene/gltf_primitive.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

/// What turns normals: the cofactors of M are det(M) times its inverse transpose, so they need no division
/// and work for flattened nodes too; the determinant's sign undoes the flip of a mirrored one.
glm::dmat3 normal_matrix(const glm::dmat3& m) {
  const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  return glm::determinant(m) < 0 ? -cofactors : cofactors;
}

class Appender {
 public:
  Appender(const GltfDocument& document, Scene& scene) : document_(document), scene_(scene) {}

  /// Makes room for `count` instances of a primitive, or refuses all of them before any is made.
  void reserve(const LocalPrimitive& primitive, std::size_t count) {
    const std::uint64_t vertices = scene_.vertices.size() + count * primitive.vertices.size();
    const std::uint64_t triangles = scene_.triangles.size() + count * primitive.triangles.size();
    if (vertices > bounds::kVertices || triangles > bounds::kTriangles) {
      refuse(document_.file, primitive.place,
             fmt::format("{} vertices and {} triangles so far, this one standing at {} nodes", vertices,
                         triangles, count),
             fmt::format("at most {} and {} in all", bounds::kVertices, bounds::kTriangles));
    }
    grow(scene_.vertices, vertices);
    grow(scene_.triangles, triangles);
  }

  void append(const LocalPrimitive& primitive, const GltfNode& node) {
    const glm::dmat3 linear(node.to_world);
    const glm::dmat3 to_normal = normal_matrix(linear);
    const bool mirrored = glm::determinant(linear) < 0;
    const auto base = static_cast<std::uint32_t>(scene_.vertices.size());
    for (const LocalVertex& local : primitive.vertices) {
      scene_.vertices.push_back(placed(local, node, to_normal, primitive));
    }
    for (const glm::uvec3& t : primitive.triangles) {
      const std::uint32_t second = base + (mirrored ? t.z : t.y), third = base + (mirrored ? t.y : t.z);
      scene_.triangles.push_back({{base + t.x, second, third}, primitive.material});
    }
  }

 private:
  /// Reserves geometrically, as push_back would: exact reserves for each primitive would copy all at each.
  template <typename T>
  static void grow(std::vector<T>& values, std::uint64_t size) {
    if (size > values.capacity()) values.reserve(std::max<std::size_t>(size, 2 * values.capacity()));
  }

  Vertex placed(const LocalVertex& local, const GltfNode& node, const glm::dmat3& to_normal,
                const LocalPrimitive& primitive) const {
    const glm::dvec3 p(node.to_world * glm::dvec4(local.position, 1));
    for (int i = 0; i < 3; ++i) {
      if (!(std::abs(p[i]) <= bounds::kCoordinate)) {
        refuse(document_.file, primitive.place,
               fmt::format("vertex {} at ({}, {}, {}) m, placed by /nodes/{}", local.source, p.x, p.y, p.z,
                           node.index),
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

  const GltfDocument& document_;
  Scene& scene_;
};

}  // namespace

void append_meshes(const GltfDocument& document, const std::vector<GltfNode>& nodes,
                   const MaterialSet& materials, Scene& scene, Notes& notes) {
  std::map<int, std::vector<const GltfNode*>>
      instances;  // each primitive is read once, however often it stands
  for (const GltfNode& node : nodes) {
    const tinygltf::Node& source = document.model.nodes[static_cast<std::size_t>(node.index)];
    if (source.mesh < 0) continue;
    instances[source.mesh].push_back(&node);
    if (source.skin >= 0) notes.add(fmt::format("/nodes/{}: skinned, shown as stored", node.index));
  }
  Appender appender(document, scene);
  VertexMap map;
  for (const auto& [mesh, placed] : instances) {
    const auto index = static_cast<std::size_t>(mesh);
    for (std::size_t i = 0; i < document.model.meshes[index].primitives.size(); ++i) {
      const Room room{bounds::kVertices - scene.vertices.size(), bounds::kTriangles - scene.triangles.size()};
      const LocalPrimitive primitive = read_primitive(document, index, i, materials, room, map, notes);
      if (primitive.triangles.empty()) continue;
      appender.reserve(primitive, placed.size());
      for (const GltfNode* node : placed) appender.append(primitive, *node);
    }
    if (!document.model.meshes[index].weights.empty()) {
      notes.add(fmt::format("/meshes/{}: morph targets are not applied", mesh));
    }
  }
}

}  // namespace clpv
