// SPDX-License-Identifier: MIT
// A primitive that stands at a node: its vertices and triangles in world space, and their places in the scene.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "scene/gltf_primitive.hpp"
#include "scene/scene.hpp"
#include "scene/skin.hpp"

namespace clpv {

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

}  // namespace clpv
