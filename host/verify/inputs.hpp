// SPDX-License-Identifier: MIT
// Random inputs for checks (surfaces, triangles, volumes), and comparison of images and volumes.
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
#include "pipeline/raster/shade.hpp"
#include "pipeline/raster/surface.hpp"
#include "reference/shade.hpp"
#include "reference/volume.hpp"
#include "scene/scene.hpp"
#include "verify/check.hpp"
#include "verify/comparison.hpp"
#include "volume/volume.hpp"

namespace clpv::reference {

/// Returns the G-buffer of a camera near the origin: random depths up to 12 m, normals, colours and emission. 10 % of
/// the pixels show no surface.
SurfaceImage random_surfaces(std::mt19937& random);

/// Compares red, green and blue of every pixel (and alpha, if the CPU reference has it) with the CPU reference. Errors
/// are relative to its largest value and compared with the stage's tolerance. `width`: image width, for places.
CheckResult compare_pixels(const std::vector<cl_float4>& device, const std::vector<glm::dvec4>& expected,
                           unsigned width, std::string_view stage, const std::string& variant);

/// Returns true if single and double precision may read different table entries. This concerns looking up `direction`,
/// and rotating a lobe to it or to its opposite. Returns false without a table.
bool rounding_decides(const Basis& basis, const LobeOptions& options, const glm::dvec3& direction);

/// Returns triangles in and around a grid of nine cells of 0.5 m from (-2.5, 0.5, 1). Sizes range from specks to far
/// larger than the grid. One has no area, some are axis-aligned, and 1 of 3 has holes.
Scene triangle_soup();

/// Returns light in 1 of 3 cells, of either sign, as from bases with negative lobes.
Volume random_light(const Basis& basis, int n, std::mt19937& random);

/// Returns `numbers` values in [0, 1] per corner.
Volume random_blockers(int numbers, int n, std::mt19937& random);

/// Returns a sun in the open and one that is blocked, a point light and a spot without maps, in a medium. Maps are empty or block
/// everything, so that rounding decides no texel.
std::vector<MappedLight> lights_in(const ClpvMedium& medium);

/// Returns lights with their maps on the device.
std::vector<ShadowedLight> on_device(Session& session, const std::vector<MappedLight>& lights);

/// Returns a volume on the device with the same values.
clpv::Volume on_device(Session& session, const Volume& from, const VolumeFormat& format);

}  // namespace clpv::reference
