// SPDX-License-Identifier: MIT
// CPU reference of kernels/gather/cascades.h and kernels/gather/gather_packed.h: samples of a
// cascade's volume and its weight, in double.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "kernels/shared/grid.h"
#include "reference/volume.hpp"
#include "scene/scene.hpp"

namespace clpv::reference {

/// Trilinear interpolation: eight cells and their weights.
struct TrilinearSample {
  std::array<glm::ivec3, 8> cell;
  std::array<double, 8> weight;
};

/// Returns the cells about `at` [cells from the first centre], clamped to a grid of n cells along
/// each axis.
TrilinearSample trilinear_sample(const glm::dvec3& at, int n);

/// Multiplies weights by the visible shares of the cells from `at`, and normalises them. `clear`: a
/// unit vector along which nothing stands, or 0. Only those sample points count that see a cell
/// which the sample point a quarter of a cell along it sees, too.
void apply_visibility(TrilinearSample& sample, const glm::dvec3& at, const glm::dvec3& clear, int n,
                      const std::uint8_t* occluded);

/// Returns true if rounding decides which cells the sample point a quarter of a cell along `clear`
/// sees.
bool rounding_decides(const glm::dvec3& at, const glm::dvec3& clear, int n,
                      const std::uint8_t* occluded);

/// Interpolated coefficients of one channel.
std::vector<double> interpolated(const Volume& volume, int channel, const TrilinearSample& sample);

/// Blend weight of a cascade at a point: 1 inside, 0 at and beyond the boundary of the cube about
/// the eye that it lights.
double share_of(const glm::dvec3& position, const ClpvGrid& grid, int n, double blend_cells);

}  // namespace clpv::reference
