// SPDX-License-Identifier: MIT
// The mip levels of a texture.
#pragma once

#include <vector>

#include "scene/scene.hpp"

namespace clpv {

/// All levels of `texture`, itself first, each half the one before (rounded down, at least 1), to 1 x 1.
/// Every texel is the mean, in linear light, of the part of the level before that it covers (two or three
/// texels along each axis). `weigh_by_alpha`: colour is the alpha-weighted mean, for textures with holes.
std::vector<Texture> mip_chain(const Texture& texture, bool weigh_by_alpha);

/// Which textures of a scene have holes: those that a masked material uses.
std::vector<bool> textures_with_holes(const Scene& scene);

/// Linear value in 0..1 of an sRGB-encoded byte, and the byte nearest to a linear value (IEC 61966-2-1).
double linear_from_srgb(unsigned byte);
unsigned srgb_from_linear(double linear);

}  // namespace clpv
