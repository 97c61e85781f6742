// SPDX-License-Identifier: MIT
// What the checks of the camera's stages share: surfaces to look at, and images held against the twin's.
#pragma once

#include <CL/opencl.hpp>
#include <glm/glm.hpp>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "basis/rotated_lobe.hpp"
#include "checks/check.hpp"
#include "pipeline/surface.hpp"

namespace clpv::reference {

/// A camera near the origin that sees surfaces at random depths up to 12 m, turned, coloured and glowing at random; a
/// tenth of the pixels see none.
SurfaceImage random_surfaces(std::mt19937& random);

/// Red, green and blue of every pixel (and alpha, where the twin has it) against the twin's; errors relative to the
/// twin's largest value, held against the stage's tolerance. `width` of the image, to name the place.
CheckResult compare_pixels(const std::vector<cl_float4>& device, const std::vector<glm::dvec4>& twin,
                           unsigned width, std::string_view stage, const std::string& variant);

/// Whether single precision may read another entry than double: in looking up `direction`, or in turning a lobe there
/// or to where it points away from. False where no table is used.
bool rounding_decides(const Basis& basis, const LobeOptions& options, const glm::dvec3& direction);

}  // namespace clpv::reference
