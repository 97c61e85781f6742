// SPDX-License-Identifier: MIT
// One mesh primitive in its own space: triangles over just the vertices they use. Internal to the loader.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/gltf_document.hpp"
#include "scene/gltf_material.hpp"
#include "scene/motion.hpp"
#include "scene/notes.hpp"

namespace clpv {

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
  std::uint64_t morph_numbers;  ///< of morph targets
};

/// Reads primitive `index` of mesh `mesh`, with the joints its vertices go with and its morph targets, which take up
/// `room.morph_numbers`. No triangles, and a note, where it is made of points or lines. Throws Error(bad_input).
LocalPrimitive read_primitive(const GltfDocument& document, int mesh, std::size_t index,
                              const MaterialSet& materials, Room& room, VertexMap& map, Notes& notes);

}  // namespace clpv
