// SPDX-License-Identifier: MIT
// What of a model moves, and how.
#pragma once

#include <cstddef>
#include <vector>

#include "scene/instance.hpp"
#include "scene/node_tree.hpp"
#include "scene/scene.hpp"

namespace clpv {

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
