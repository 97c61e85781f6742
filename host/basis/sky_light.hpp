// SPDX-License-Identifier: MIT
// A sky's light along the sweep's directions: the boundary condition of the coarsest cascade
// (docs/method.md, 'The sweep'). Without OpenCL.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scene/sky.hpp"

namespace clpv {

/// Returns the sky's mean radiance [W/m^2/sr] over each part of each bin (sweep_bins): [bin *
/// parts^2 + part]. A part collects light that travels along it, so it averages the sky over the
/// opposite directions.
std::vector<glm::dvec3> sky_means(const Sky& sky, int parts);

/// Returns D = L |w_m| of the sky at the border for cells of 1 m^2, in the order of ordinate_of
/// (kernels/sweep/sweep_border.h).
std::vector<float> swept_sky(const Sky& sky, int parts);

}  // namespace clpv
