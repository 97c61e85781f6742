// SPDX-License-Identifier: MIT
// Rays through a homogeneous medium in a box (kernels/shared/light.h; docs/method.md, 'Media'), in
// double.
#pragma once

#include <glm/glm.hpp>

#include "kernels/shared/light.h"

namespace clpv {

/// Part of a ray inside a medium, in lengths of the ray's direction; empty if end <= start.
struct MediumPart {
  double start = 0, end = 0;

  double length() const { return end > start ? end - start : 0; }
};

/// Returns the part of origin + t direction, t in (0, end), in the medium; none if the medium does
/// not attenuate. `end` may be infinite.
MediumPart medium_part(const ClpvMedium& medium, const glm::dvec3& origin,
                       const glm::dvec3& direction, double end);

/// exp(-sigma_t l) for each channel. `part`: of a ray with a unit direction [m].
glm::dvec3 transmittance(const ClpvMedium& medium, const MediumPart& part);

}  // namespace clpv
