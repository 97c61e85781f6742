// SPDX-License-Identifier: MIT
// Directions of the rays of the near field (docs/method.md, 'Near field').
#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace clpv {

/// Unit directions about +z with density cos / pi: `rays` for each of the 4 x 4 pixels of a tile,
/// [4 y + x][ray]. All of a tile together, and those of each pixel, are (0,2)-nets. `rays` is a
/// power of two.
std::vector<std::vector<glm::vec3>> near_directions(int rays);

/// Width of a ray's cone over its length, for filtering textures: the rays of a tile share the
/// hemisphere.
double near_cone(int rays);

}  // namespace clpv
