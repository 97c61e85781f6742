// SPDX-License-Identifier: MIT
// A sky, where a view sees no surface.
#pragma once

#include <vector>

#include "kernels/shared/view.h"
#include "scene/sky.hpp"

namespace clpv {

/// Gives pixels of an RGBA image without alpha the radiance of the sky that they look at, and alpha 1.
void paint_sky(const Sky& sky, const ClpvView& view, std::vector<float>& image);

}  // namespace clpv
