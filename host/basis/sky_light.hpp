// SPDX-License-Identifier: MIT
// What a sky sends along the directions that light is swept along. Knows no OpenCL.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scene/sky.hpp"

namespace clpv {

/// Mean radiance of each part of each bin (sweep_bins), [bin * parts^2 + part]: the integral of the sky over where light along
/// the part comes from, over its solid angle.
std::vector<glm::dvec3> sky_means(const Sky& sky, int parts);

/// What comes in through cells of 1 m^2, in the order of CLPV_SWEPT (kernels/sweep_border.h): D = L |w_m|.
std::vector<float> swept_sky(const Sky& sky, int parts);

}  // namespace clpv
