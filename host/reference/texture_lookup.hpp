// A scene's textures on the host: decoded to linear light, wrapped, filtered.
#pragma once

#include <glm/glm.hpp>

#include "scene/scene.hpp"

namespace clpv::reference {

/// The texture at (u, v): linear RGB and alpha. Bilinear between the four texels round it, each decoded from
/// sRGB before it is weighted; texel (0, 0) fills [0, 1/width] x [0, 1/height]. Non-finite coordinates read
/// texel (0, 0).
glm::vec4 look_up(const Texture& texture, const glm::vec2& uv);

}  // namespace clpv::reference
