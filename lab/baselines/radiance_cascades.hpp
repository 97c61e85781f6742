// SPDX-License-Identifier: MIT
// Baseline: radiance cascades in world space (Sannikov, 'Radiance Cascades: A Novel Approach to
// Calculating Global Illumination', 2023), on the CPU with Embree. One bounce, without history.
//
// Probes of cascade i have 2^i times the spacing of cascade 0, 4^i times its directions, and
// intervals that are ratio^i times as long and begin where those of cascade i - 1 end. Merging
// starts with the coarsest cascade. A ray that leaves its interval takes the mean radiance of
// the four finer directions within its own, trilinearly between the eight probes of the next
// cascade.
//
// Two rays that meet at the end of an interval start at different probes and in different
// directions, so a surface can lie between the end of the one and the start of the other. Such
// light would be lost. Trilinear merging skips probes that the ray's own probe does not see, and
// rays that a surface blocks before their interval begins; where none is left, the ray goes on
// to its end.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <unordered_map>
#include <vector>

#include "baselines/view.hpp"
#include "kernels/shared/grid.h"

namespace clpv::baselines {

struct RadianceCascadeSettings {
  unsigned side = 1;      ///< cascade 0 has 12 side^2 directions
  float spacing = 1;      ///< spacing of cascade 0 [cells]
  float first = 2;        ///< length of the intervals of cascade 0 [its spacing]
  float ratio = 2;        ///< ratio of intervals' lengths from cascade to cascade
  unsigned cascades = 3;  ///< the last one's intervals have no end
};

/// Directions of the pixels of HEALPix with `side`^2 in each of its 12 faces, of equal solid angles
/// (Gorski et al., 'HEALPix', The Astrophysical Journal 622, 2005).
std::vector<glm::vec3> healpix_directions(unsigned side);

/// Index of the direction `which` (0 to 3) of 2 side within a direction of `side`.
std::size_t healpix_child(std::size_t direction, unsigned side, unsigned which);

struct CascadedImage {
  Irradiance irradiance;
  std::size_t bytes = 0, probes = 0;  ///< bytes of radiance; probes of cascade 0
};

/// Irradiance by radiance cascades over the finest grid that encloses each pixel; 0 beyond all
/// grids. Only probes that pixels need are traced.
CascadedImage radiance_cascades(const View& view, const std::vector<ClpvGrid>& grids,
                                const RadianceCascadeSettings& settings);

}  // namespace clpv::baselines
