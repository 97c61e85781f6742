// SPDX-License-Identifier: MIT
// CPU reference of kernels/gather/cascades.h and kernels/gather/gather_packed.h: samples of a
// cascade's volume and its weight, in double.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "basis/basis.hpp"
#include "kernels/shared/grid.h"
#include "options/stage_options.hpp"
#include "reference/gather.hpp"
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

/// Returns the cells that light `at` [cells from the first centre] of a cascade: by trilinear
/// weights times their visible shares, normalised. Only those sample points count that see a cell
/// which the sample point 0.85 cells along the clear way, or at its end, sees, too; where it sees
/// none, the next one towards the eye takes its place. Where too little is visible, the cells count
/// that this point sees, or all without such a way; where the white furnace is dark, those that the
/// next one sees. Trilinear weights alone if options.gather is Gathering::all.
TrilinearSample sample_of(const GatherOptions& options, const Cascade& cascade,
                          const glm::dvec3& at, const ClearWay& clear);

/// Returns true if rounding decides which sample point lies at `at` [cells], or along `clear` in
/// cells of `cell` [m].
bool rounding_decides(const glm::dvec3& at, int n);
bool rounding_decides(const glm::dvec3& at, const ClearWay& clear, double cell, int n);

/// Returns whether the sample points at `a` and `b` [cells] see a cell in common; true if they are
/// farther apart than cells that have one.
bool see_a_cell(const glm::dvec3& a, const glm::dvec3& b, int n, const std::uint8_t* occluded);

/// Interpolated coefficients of one channel.
std::vector<double> interpolated(const Volume& volume, int channel, const TrilinearSample& sample);

/// Blend weight of a cascade at a point: 1 inside, 0 at and beyond the boundary of the cube about
/// the eye that it lights.
double share_of(const glm::dvec3& position, const ClpvGrid& grid, int n, double blend_cells);

// CPU reference of kernels/gather/radiance.h: radiance from volumes of swept light, in double.

/// Coefficients of the radiance at a point, and of the white furnace's, in the basis of swept
/// light, by channel.
using RadianceField = std::array<std::vector<double>, 4>;

/// Returns coefficients at position + offset s lift of each cascade, s its cell, blended by the
/// cascades' shares at `position` [m]. `clear`: sample_of().
RadianceField radiance_field(const GatherOptions& options, const std::vector<Cascade>& cascades,
                             int coefficients, const glm::dvec3& position, double offset = 0,
                             const glm::dvec3& lift = glm::dvec3(0), const ClearWay& clear = {});

/// Returns L(p, w) [W/m^2/sr], light that travels along the unit vector w. May be negative.
glm::dvec3 radiance(const Basis& basis, const RadianceField& field, const glm::dvec3& w);

/// Returns the irradiance of a surface with unit `normal`, at least 0, before the furnace's, the
/// fourth number, divides it.
glm::dvec4 raw_irradiance(const Basis& basis, const RadianceField& field, const glm::dvec3& normal);

/// Returns the irradiance [W/m^2] of a surface with unit `normal`, at least 0.
glm::dvec3 field_irradiance(const Basis& basis, const RadianceField& field,
                            const glm::dvec3& normal);

}  // namespace clpv::reference
