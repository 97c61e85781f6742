// SPDX-License-Identifier: MIT
// Integrals over the sphere and parts of it, split where the integrand has kinks or jumps.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "basis/basis.hpp"

namespace clpv {

/// A convex region bounded by great circles: its corners, unit vectors in order, all within one hemisphere.
using SphericalPolygon = std::vector<glm::dvec3>;

/// A direction and its share of solid angle [sr].
struct QuadratureNode {
  glm::dvec3 w;
  double weight;
};

/// The whole sphere, as its eight octants.
std::vector<SphericalPolygon> octants();

/// The polygons cut along planes through the origin, given by their unit normals.
std::vector<SphericalPolygon> split(std::vector<SphericalPolygon> polygons,
                                    std::span<const glm::dvec3> planes);

/// Solid angle of a polygon [sr].
double solid_angle(const SphericalPolygon& polygon);

/// 144 nodes a triangle of the polygon's fan: integrates a smooth function over a small polygon to rounding.
std::vector<QuadratureNode> nodes_of(const SphericalPolygon& polygon);

/// Nodes over the polygons, fine enough that products of two basis functions and of powers of |w_x|, |w_y|,
/// |w_z| and |w|_1 integrate to 1e-14 of their size: none crosses a coordinate plane or a crease of the
/// basis. Throws Error(run_time) where the basis is too peaked (lambda very near 1).
std::vector<QuadratureNode> quadrature(const Basis& basis, const std::vector<SphericalPolygon>& polygons);

}  // namespace clpv
