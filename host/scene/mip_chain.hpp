// SPDX-License-Identifier: MIT
// Mip levels of textures.
#pragma once

#include <vector>

#include "scene/scene.hpp"

namespace clpv {

/// Mip levels of `texture`, starting with itself. Each level halves the size, rounded down, to 1 x
/// 1. A texel is the mean, in linear light, of the area of the previous level that it covers (2 or
/// 3 texels along each axis). `weigh_by_alpha`: colour is the alpha-weighted mean, for textures
/// with holes.
std::vector<Texture> mip_chain(const Texture& texture, bool weigh_by_alpha);

/// One value per texture of the scene: true for those with holes, which a masked material uses.
std::vector<bool> textures_with_holes(const SceneData& scene);

/// Linear value in [0, 1] of an sRGB-encoded byte, and the nearest byte of a linear value (IEC
/// 61966-2-1).
double linear_from_srgb(unsigned byte);
unsigned srgb_from_linear(double linear);

}  // namespace clpv
