// SPDX-License-Identifier: MIT
// One mesh primitive in its own space: triangles over just the vertices they use. Internal to the loader.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "scene/gltf_document.hpp"
#include "scene/gltf_material.hpp"
#include "scene/notes.hpp"

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

/// Vertices of an accessor -> vertices of a primitive, made anew for each primitive without clearing:
/// primitives often share one huge accessor and use a small part of it.
class VertexMap {
 public:
  /// Starts a new map for `count` source vertices.
  void restart(std::size_t count);
  /// The slot of a source vertex; `fresh` is taken, and increased, at its first use.
  std::uint32_t slot(std::uint32_t source, std::uint32_t& fresh);

 private:
  struct Entry {
    std::uint32_t stamp = 0, slot = 0;
  };
  std::vector<Entry> entries_;
  std::uint32_t stamp_ = 0;
};

/// How much more the scene may hold.
struct Room {
  std::uint64_t vertices, triangles;
};

/// Reads primitive `index` of mesh `mesh`. No triangles, and a note, where it is made of points or lines.
/// Throws Error(bad_input).
LocalPrimitive read_primitive(const GltfDocument& document, std::size_t mesh, std::size_t index,
                              const MaterialSet& materials, const Room& room, VertexMap& map, Notes& notes);

}  // namespace clpv
