// SPDX-License-Identifier: MIT
// A scene's textures on the host: decoded to linear light, wrapped, filtered.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scene/scene.hpp"

namespace clpv::reference {

/// The texture at (u, v): linear RGB and alpha. Bilinear between the four texels round it, each decoded from
/// sRGB before it is weighted; texel (0, 0) fills [0, 1/width] x [0, 1/height]. Non-finite coordinates read
/// texel (0, 0).
glm::vec4 look_up(const Texture& texture, const glm::vec2& uv);

/// The same between the two mip levels (mip_chain) whose texels are about as large as the longer of the two
/// steps in (u, v) from pixel to pixel, as the rasteriser filters (kernels/texture.h: the level is log2 of the
/// step, drawn as straight lines). Steps that are no number take the coarsest level.
glm::vec4 look_up(const std::vector<Texture>& levels, const glm::vec2& uv, const glm::dvec2& step_x,
                  const glm::dvec2& step_y);

}  // namespace clpv::reference
