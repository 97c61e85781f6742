// SPDX-License-Identifier: MIT
// Quadrature on the sphere and on spherical polygons, split where the integrand is not smooth.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "basis/basis.hpp"

namespace clpv {

/// Convex spherical polygon bounded by great circles: corners as unit vectors in order, within one
/// hemisphere.
using SphericalPolygon = std::vector<glm::dvec3>;

/// A unit direction and its weight [sr].
struct QuadratureNode {
  glm::dvec3 w;
  double weight;
};

/// Returns the eight octants of the sphere.
std::vector<SphericalPolygon> octants();

/// Splits polygons along planes through the origin with the unit normals `planes`.
std::vector<SphericalPolygon> split(std::vector<SphericalPolygon> polygons,
                                    std::span<const glm::dvec3> planes);

/// Returns the solid angle of a polygon [sr] (Van Oosterom and Strackee 1983).
double solid_angle(const SphericalPolygon& polygon);

/// Returns 144 nodes per triangle of the polygon's fan: exact to rounding for smooth functions on a
/// small polygon.
std::vector<QuadratureNode> nodes_of(const SphericalPolygon& polygon);

/// Returns nodes over the polygons that integrate products of two basis functions, and of powers of
/// |w_x|, |w_y|, |w_z| and |w|_1, with a relative error of 1e-14. Splits at coordinate planes and
/// at the basis's creases. Throws Error(usage) if the basis is too peaked (lambda very near 1).
std::vector<QuadratureNode> quadrature(const Basis& basis,
                                       const std::vector<SphericalPolygon>& polygons);

}  // namespace clpv
