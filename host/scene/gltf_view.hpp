// SPDX-License-Identifier: MIT
// glTF cameras and KHR_lights_punctual as a scene's cameras and lights.
#pragma once

#include <vector>

#include "scene/gltf_document.hpp"
#include "scene/gltf_nodes.hpp"
#include "scene/notes.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// Appends the cameras and lights that nodes carry. Lengths of the file (near planes, ranges) are in its
/// units, of `metres_per_unit`; nodes' scales do not touch them, nor intensities. Names are made unique.
/// Throws Error(bad_input).
void append_views(const GltfDocument& document, const std::vector<GltfNode>& nodes, double metres_per_unit,
                  Scene& scene, Notes& notes);

}  // namespace clpv
