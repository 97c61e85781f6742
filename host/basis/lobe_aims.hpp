// SPDX-License-Identifier: MIT
// What clamped cosines are wanted for: all directions alike, or some directions by their weights; how far off a basis is
// on the whole; and how little that can be.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "basis/basis.hpp"

namespace clpv {

struct WeightedDirection {
  glm::dvec3 direction;  ///< unit
  double weight;         ///< above 0
};

/// Where clamped cosines shall point. Weights add up to 1.
struct LobeAims {
  std::string name;
  std::vector<WeightedDirection> directions;  ///< empty: all directions alike
};

LobeAims all_directions();
/// The six axes, along which propagation has its lobes.
LobeAims propagation_axes();
/// From a JSON file {"weights": [[x, y, z, weight], ...]}, as `clpv render --dump-normals` writes them. Throws
/// Error(bad_input) with the JSON pointer of what is wrong.
LobeAims load_aims(const std::string& path);

/// |f - max(0, w . d)| / |max(0, w . d)|, L2 norms over the sphere, of the function with coefficients c.
double relative_l2(const Basis& basis, std::span<const double> c, const glm::dvec3& d);

inline constexpr int kEvenDirections = 2000;  ///< a mean over so many is good to three digits
/// Directions spread evenly, on a golden spiral.
std::vector<glm::dvec3> even_directions(int count);

/// Root of the weighted mean of |f - max(0, w . d)|^2 / |max(0, w . d)|^2 over d, f the exact projection for each d.
double error_over(const Basis& basis, const LobeAims& aims);

/// The least that this can be over all directions, by any N functions there are. The clamped cosines of all directions
/// make a zonal operator, whose eigenfunctions are spherical harmonics: N functions do best that span those of the
/// largest eigenvalues. Hence sh2 and sh3 are the best of 4 and of 9 functions.
double least_error_of(int functions);

}  // namespace clpv
