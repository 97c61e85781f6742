// SPDX-License-Identifier: MIT
// A primitive that stands at a node: its vertices and triangles in world space, and their places in the scene.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <string>

#include "scene/gltf_primitive.hpp"
#include "scene/scene.hpp"

namespace clpv {

struct Instance {
  std::shared_ptr<const LocalPrimitive> primitive;
  int node_index = 0;                                  ///< in the document, for messages
  std::uint32_t first_vertex = 0, first_triangle = 0;  ///< in the scene, which has room for all from there on
};

/// Writes its vertices [m] and triangles into the scene, as `to_world` places them; a mirrored one keeps its outside
/// outside. Throws Error(bad_input) that names `file` for coordinates beyond the bounds.
void place(const Instance& instance, const glm::dmat4& to_world, const std::string& file, Scene& scene);

}  // namespace clpv
