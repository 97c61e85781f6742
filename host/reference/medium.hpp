// SPDX-License-Identifier: MIT
// Paths through a homogeneous medium in a box (kernels/shared/light.h, kernels/gather/medium.h), and CPU references of stage `medium`
// (kernels/gather/medium.cl) and of the light that it scatters in cells (kernels/sweep/sweep_medium.cl), in double.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "basis/basis.hpp"
#include "image/surface_image.hpp"
#include "kernels/shared/light.h"
#include "options/stage_options.hpp"
#include "reference/gather.hpp"
#include "reference/shade.hpp"
#include "reference/volume.hpp"

namespace clpv::reference {

/// Part of a ray inside a medium, in lengths of the ray's direction; empty if end <= start.
struct MediumPart {
  double start = 0, end = 0;

  double length() const { return end > start ? end - start : 0; }
};

/// Returns the part of origin + t direction, t in (0, end), in the medium. `end` may be infinite.
MediumPart medium_part(const ClpvMedium& medium, const glm::dvec3& origin, const glm::dvec3& direction,
                       double end);

/// exp(-sigma_t l) for each channel. `part`: of a ray with a unit direction [m].
glm::dvec3 transmittance(const ClpvMedium& medium, const MediumPart& part);

/// Returns true if light is scattered or absorbed at all.
bool attenuates(const ClpvMedium& medium);

struct MediumScene {
  const ClpvMedium& medium;
  const std::vector<MappedLight>& lights;
  const std::vector<Cascade>& cascades;  ///< finest first
};

/// Returns the radiance [W/m^2/sr] that the medium scatters towards the camera in each pixel. `basis`: of the cascades' volumes,
/// swept_basis().
std::vector<glm::dvec3> scattered_light(const Basis& basis, const MediumOptions& options,
                                        const MediumScene& scene, const SurfaceImage& camera);

/// Returns the source function of `lights` in the cells of `grid`, times s^2 [W/sr], in bins24 (kernels/sweep/sweep_medium.cl).
Volume scattered_in_cells(const ClpvMedium& medium, const std::vector<MappedLight>& lights,
                          const ClpvGrid& grid);
/// Adds that of `swept` light, the result of sweep().
void add_scattered(const ClpvMedium& medium, const Volume& swept, Volume& scattered);

}  // namespace clpv::reference
