// SPDX-License-Identifier: MIT
// glTF cameras and KHR_lights_punctual as a scene's cameras and lights.
#pragma once

#include "scene/gltf_document.hpp"
#include "scene/motion.hpp"
#include "scene/notes.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// Appends the cameras and lights that the nodes of `motion.tree` carry, which `posed` places. Lengths of the file (near
/// planes, ranges) are in its units, of `metres_per_unit`; nodes' scales do not touch them, nor intensities. Names are made
/// unique. Those at nodes that move become `motion.cameras` and `motion.lights` too. Throws Error(bad_input).
void append_views(const GltfDocument& document, const PosedTree& posed, double metres_per_unit, Scene& scene,
                  Motion& motion, Notes& notes);

}  // namespace clpv
