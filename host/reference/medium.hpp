// SPDX-License-Identifier: MIT
// CPU references of stage `medium` (kernels/gather/medium.cl) and of the light that a medium
// scatters in cells (kernels/sweep/sweep_medium.cl), in double.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "basis/basis.hpp"
#include "image/image.hpp"
#include "kernels/shared/light.h"
#include "options/stage_options.hpp"
#include "reference/gather.hpp"
#include "reference/shade.hpp"
#include "reference/volume.hpp"

namespace clpv::reference {

struct MediumScene {
  const ClpvMedium& medium;
  const std::vector<MappedLight>& lights;
  const std::vector<Cascade>& cascades;  ///< finest first
};

/// Returns the radiance [W/m^2/sr] that the medium scatters towards the camera in each pixel.
/// `basis`: of the cascades' volumes, swept_basis().
std::vector<glm::dvec3> scattered_light(const Basis& basis, const MediumOptions& options,
                                        const MediumScene& scene, const SurfaceImage& camera);

/// Returns the source function of `lights` in the cells of `grid`, times s^2 [W/sr], in bins24
/// (kernels/sweep/sweep_medium.cl).
Volume scattered_in_cells(const ClpvMedium& medium, const std::vector<MappedLight>& lights,
                          const ClpvGrid& grid);
/// Adds the source function of `swept`, a result of sweep().
void add_scattered(const ClpvMedium& medium, const Volume& swept, Volume& scattered);

}  // namespace clpv::reference
