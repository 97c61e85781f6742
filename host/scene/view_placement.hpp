// SPDX-License-Identifier: MIT
// Cameras and lights where a node puts them.
#pragma once

#include <glm/glm.hpp>
#include <string>

#include "scene/scene.hpp"

namespace clpv {

/// Sets eye, forward and up: it looks along the node's -z. `file` and `node`, its index, are for messages. Throws
/// Error(bad_input) for coordinates beyond the bounds and transforms that leave no direction; so does place_light.
void place_camera(Camera& camera, const glm::dmat4& to_world, const std::string& file, int node);

/// Sets position, and the direction of what has one: along the node's -z.
void place_light(ClpvLight& light, const glm::dmat4& to_world, const std::string& file, int node);

}  // namespace clpv
