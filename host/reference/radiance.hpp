// SPDX-License-Identifier: MIT
// CPU reference of kernels/gather/radiance.h: radiance from volumes of swept light, in double.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "basis/basis.hpp"
#include "options/stage_options.hpp"
#include "reference/gather.hpp"

namespace clpv::reference {

/// Coefficients of the radiance at a point, and of the white furnace's, in the basis of swept
/// light, by channel.
using RadianceField = std::array<std::vector<double>, 4>;

/// Returns coefficients at position + offset s lift of each cascade, s its cell, blended by the
/// cascades' shares at `position` [m]. `clear`: apply_visibility().
RadianceField radiance_field(const GatherOptions& options, const std::vector<Cascade>& cascades,
                             int coefficients, const glm::dvec3& position, double offset = 0,
                             const glm::dvec3& lift = glm::dvec3(0),
                             const glm::dvec3& clear = glm::dvec3(0));

/// Returns L(p, w) [W/m^2/sr], light that travels along the unit vector w. May be negative.
glm::dvec3 radiance(const Basis& basis, const RadianceField& field, const glm::dvec3& w);

/// Returns the irradiance of a surface with unit `normal`, at least 0, before the furnace's, the
/// fourth number, divides it.
glm::dvec4 raw_irradiance(const Basis& basis, const RadianceField& field, const glm::dvec3& normal);

/// Returns the irradiance [W/m^2] of a surface with unit `normal`, at least 0.
glm::dvec3 field_irradiance(const Basis& basis, const RadianceField& field,
                            const glm::dvec3& normal);

}  // namespace clpv::reference
