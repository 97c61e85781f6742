// SPDX-License-Identifier: MIT
#include "scene/gltf_mesh.hpp"

#include <algorithm>
#include <map>

#include "scene/bounds.hpp"
#include "scene/gltf_primitive.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

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

  /// The primitive at a node: placed, and where it is in the scene.
  Instance append(std::shared_ptr<const LocalPrimitive> primitive, int node, const glm::dmat4& to_world) {
    Instance made{std::move(primitive), node, static_cast<std::uint32_t>(scene_.vertices.size()),
                  static_cast<std::uint32_t>(scene_.triangles.size())};
    scene_.vertices.resize(scene_.vertices.size() + made.primitive->vertices.size());
    scene_.triangles.resize(scene_.triangles.size() + made.primitive->triangles.size());
    place(made, to_world, document_.file, scene_);
    return made;
  }

 private:
  /// Reserves geometrically, as push_back would: exact reserves for each primitive would copy all at each.
  template <typename T>
  static void grow(std::vector<T>& values, std::uint64_t size) {
    if (size > values.capacity()) values.reserve(std::max<std::size_t>(size, 2 * values.capacity()));
  }

  const GltfDocument& document_;
  Scene& scene_;
};

}  // namespace

void append_meshes(const GltfDocument& document, const std::vector<glm::dmat4>& to_world,
                   const MaterialSet& materials, Scene& scene, Motion& motion, Notes& notes) {
  const std::vector<TreeNode>& nodes = motion.tree.nodes;
  std::map<int, std::vector<std::size_t>> stands;  // each primitive is read once, however often it stands
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const tinygltf::Node& source = document.model.nodes[static_cast<std::size_t>(nodes[i].index)];
    if (source.mesh < 0) continue;
    stands[source.mesh].push_back(i);
    if (source.skin >= 0) notes.add(fmt::format("/nodes/{}: skinned, shown as stored", nodes[i].index));
  }
  Appender appender(document, scene);
  VertexMap map;
  for (const auto& [mesh, at] : stands) {
    const auto index = static_cast<std::size_t>(mesh);
    for (std::size_t i = 0; i < document.model.meshes[index].primitives.size(); ++i) {
      const Room room{bounds::kVertices - scene.vertices.size(), bounds::kTriangles - scene.triangles.size()};
      const auto primitive = std::make_shared<const LocalPrimitive>(
          read_primitive(document, index, i, materials, room, map, notes));
      if (primitive->triangles.empty()) continue;
      appender.reserve(*primitive, at.size());
      for (const std::size_t node : at) {
        Instance instance = appender.append(primitive, nodes[node].index, to_world[node]);
        if (nodes[node].moves) motion.meshes.push_back({std::move(instance), node});
      }
    }
    if (!document.model.meshes[index].weights.empty()) {
      notes.add(fmt::format("/meshes/{}: morph targets are not applied", mesh));
    }
  }
}

}  // namespace clpv
