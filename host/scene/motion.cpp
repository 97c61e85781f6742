// SPDX-License-Identifier: MIT
#include "scene/motion.hpp"

#include "scene/view_placement.hpp"

namespace clpv {

void Motion::pose(Scene& scene, double seconds) const {
  if (empty()) return;
  const std::vector<glm::dmat4> to_world = tree.to_world(seconds);
  for (const MovingMesh& mesh : meshes) place(mesh.instance, to_world[mesh.node], tree.file, scene);
  for (const MovingView& each : cameras) {
    place_camera(scene.cameras[each.view], to_world[each.node], tree.file, tree.nodes[each.node].index);
  }
  for (const MovingView& each : lights) {
    place_light(scene.lights[each.view].data, to_world[each.node], tree.file, tree.nodes[each.node].index);
  }
}

}  // namespace clpv
