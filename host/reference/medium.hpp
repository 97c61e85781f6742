// SPDX-License-Identifier: MIT
// CPU reference of kernels/medium.h: paths through a homogeneous medium in a box (kernels/shared/light.h).
#pragma once

#include <glm/glm.hpp>

#include "kernels/shared/light.h"

namespace clpv::reference {

/// Part of a ray inside a medium, in lengths of the ray's direction; empty if end <= start.
struct MediumPart {
  double start = 0, end = 0;

  double length() const { return end > start ? end - start : 0; }
};

/// Returns the part of origin + t direction, t in (0, end), in the medium. `end` may be infinite.
MediumPart medium_part(const ClpvMedium& medium, const glm::dvec3& origin, const glm::dvec3& direction, double end);

/// exp(-sigma_t l) for each channel. `part`: of a ray with a unit direction [m].
glm::dvec3 transmittance(const ClpvMedium& medium, const MediumPart& part);

/// Phase function of Henyey and Greenstein [1/sr]. `cosine`: between the directions of travel before and after.
double phase(double anisotropy, double cosine);

/// Returns true if light is scattered or absorbed at all.
bool attenuates(const ClpvMedium& medium);

}  // namespace clpv::reference
