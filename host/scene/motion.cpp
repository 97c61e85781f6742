// SPDX-License-Identifier: MIT
#include "scene/motion.hpp"

#include "scene/view_placement.hpp"

namespace clpv {

void Motion::pose(Scene& scene, double seconds) const {
  if (empty()) return;
  PosedTree posed(tree, seconds);
  for (const Instance& instance : meshes) place(instance, posed, scene);
  for (const MovingView& each : cameras) {
    place_camera(scene.cameras[each.view], posed.to_world(each.node), tree.file, tree.nodes[each.node].index);
  }
  for (const MovingView& each : lights) {
    place_light(scene.lights[each.view].data, posed.to_world(each.node), tree.file,
                tree.nodes[each.node].index);
  }
}

}  // namespace clpv
