// SPDX-License-Identifier: MIT
// Distributions of directions of clamped cosines, a basis's mean error over one, and its lower bound (docs/bases.md).
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "basis/basis.hpp"

namespace clpv {

/// A direction and its weight.
struct WeightedDirection {
  glm::dvec3 direction;  ///< unit
  double weight;         ///< above 0
};

/// Distribution of directions of clamped cosines. Weights sum to 1.
struct LobeAims {
  std::string name;
  std::vector<WeightedDirection> directions;  ///< empty: uniform over the sphere
};

LobeAims all_directions();  ///< uniform over the sphere
/// The six axes, along which propagation emits its lobes.
LobeAims propagation_axes();
/// Loads a JSON file {"weights": [[x, y, z, weight], ...]}, as `clpv render --dump-normals` writes it. Throws
/// Error(bad_input) with the JSON pointer of the invalid value.
LobeAims load_aims(const std::string& path);

/// Returns |f - max(0, w . d)| / |max(0, w . d)|, L2 norms over the sphere, for f with coefficients c (N).
double relative_l2(const Basis& basis, std::span<const double> c, const glm::dvec3& d);

inline constexpr int kEvenDirections = 2000;  ///< gives means to three digits

/// Returns `count` evenly distributed unit directions on a golden spiral.
std::vector<glm::dvec3> even_directions(int count);

/// Returns the root of the weighted mean over d of |f - max(0, w . d)|^2 / |max(0, w . d)|^2, f the exact projection.
double error_over(const Basis& basis, const LobeAims& aims);

/// Returns the minimum of error_over(all_directions()) over all bases of N functions. Clamped cosines of all directions
/// form a zonal operator whose eigenfunctions are spherical harmonics. The optimal basis spans those of the largest
/// eigenvalues: sh2 of 4 functions, sh3 of 9.
double minimum_error(int functions);

}  // namespace clpv
