// SPDX-License-Identifier: MIT
// What blocks light: what a surfel adds to a sample of the geometry volume, and how much of the light along a direction
// such a sample keeps back (MATH section 4). Knows no OpenCL.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "basis/basis.hpp"
#include "basis/rotated_lobe.hpp"
#include "support/named_enum.hpp"

namespace clpv {

/// A surfel that covers the share A of a cell's cross-section, its normal n.
enum class Blocking {
  /// 3 numbers: A |n_x|, A |n_y|, A |n_z|, which is what it covers of a face across each axis.
  areas,
  one_sided,  ///< N coefficients: A times the clamped cosine round n; blocks what meets its front (the paper)
};

template <>
inline constexpr auto kNames<Blocking> = name_list("areas", "one-sided");

/// Whether a surfel is a lobe in the basis, or else numbers of its own.
bool blocks_by_lobes(Blocking blocking);

/// Numbers a sample of the geometry volume has.
int blocking_size(Blocking blocking, const Basis& basis);

/// Weights of those numbers whose sum is the share B of light travelling along `direction` (unit) that is blocked: a
/// basis looked up against it, b(-direction); areas by |direction_a|, exact for light along an axis, and for surfels
/// across one whatever the light.
std::vector<double> blocking_weights(Blocking blocking, const Basis& basis, const LobeOptions& lobes,
                                     const glm::dvec3& direction);

}  // namespace clpv
