// SPDX-License-Identifier: MIT
// Random inputs that checks share (surfaces, triangles, volumes), and how images and volumes compare.
#pragma once

#include <CL/opencl.hpp>
#include <cstddef>
#include <glm/glm.hpp>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "basis/basis.hpp"
#include "basis/rotated_lobe.hpp"
#include "pipeline/surface.hpp"
#include "reference/volume.hpp"
#include "scene/scene.hpp"
#include "verify/check.hpp"
#include "verify/comparison.hpp"
#include "volume/volume.hpp"

namespace clpv::reference {

/// A camera near the origin that sees surfaces at random depths up to 12 m, turned, coloured and glowing at random; a
/// tenth of the pixels see none.
SurfaceImage random_surfaces(std::mt19937& random);

/// Red, green and blue of every pixel (and alpha, where the CPU reference has it) against the CPU reference's; errors relative to the
/// CPU reference's largest value, held against the stage's tolerance. `width` of the image, to name the place.
CheckResult compare_pixels(const std::vector<cl_float4>& device, const std::vector<glm::dvec4>& expected,
                           unsigned width, std::string_view stage, const std::string& variant);

/// Whether single precision may read another entry than double: in looking up `direction`, or in turning a lobe there
/// or to where it points away from. False where no table is used.
bool rounding_decides(const Basis& basis, const LobeOptions& options, const glm::dvec3& direction);

/// Triangles in and round a grid of nine cells of half a metre from (-2.5, 0.5, 1) on: specks, some of some cells, others
/// far larger than the grid, one without area, some along an axis, and a third of them with holes.
Scene triangle_soup();

/// Light in a third of the cells, of any sign, as bases with negative lobes leave it.
Volume random_light(const Basis& basis, int n, std::mt19937& random);

/// `numbers` a corner, in [0, 1].
Volume random_blockers(int numbers, int n, std::mt19937& random);

/// A volume on the device that holds the same numbers.
clpv::Volume on_device(Session& session, const Volume& from, const VolumeFormat& format);

}  // namespace clpv::reference
