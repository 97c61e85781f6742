// SPDX-License-Identifier: MIT
// Mirrors of the grid as signed permutations of the numbers of a cell: the symmetries that generated code uses.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "basis/basis.hpp"

namespace clpv {

/// Maps input i to sign[i] times input target[i]; its own inverse.
struct SignedPermutation {
  std::vector<int> target;
  std::vector<int> sign;
  bool exists() const { return !target.empty(); }
};

/// Mirror of `axis` (0 x, 1 y, 2 z) on the functions of a basis: b_i(mirrored w) = sign[i]
/// b_target[i](w). Found numerically; does not exist() if the basis is not closed under it (srbf4 in y).
SignedPermutation mirror(const Basis& basis, int axis);

/// Mirrors of x, y and z.
struct Mirrors {
  std::array<SignedPermutation, 3> all;
  std::vector<SignedPermutation> list() const { return {all.begin(), all.end()}; }
  /// Mirrors of the two other axes.
  std::vector<SignedPermutation> across(int axis) const;
};
Mirrors mirrors_of(const Basis& basis);
/// Mirrors of six fluxes in the order of kAxes: each swaps the two fluxes of its axis.
Mirrors mirrors_of_fluxes();

/// The axis, 0 to 2, of a vector along one.
int axis_of(const glm::ivec3& along);

}  // namespace clpv
