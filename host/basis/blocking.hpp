// SPDX-License-Identifier: MIT
// Representations of blockers in the geometry volume, and the blocking potential along a direction
// (docs/method.md, 'Blockers'). Without OpenCL.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "basis/basis.hpp"
#include "basis/rotated_lobe.hpp"
#include "support/named_enum.hpp"

namespace clpv {

/// Representation of a surfel of normal n whose area is the share A of a cell's cross-section.
enum class Blocking {
  /// 3 numbers: A |n_x|, A |n_y|, A |n_z|, the covered share of a face across each axis.
  areas,
  one_sided,  ///< N coefficients: A times the clamped cosine about n; blocks light against n only
              ///< (the paper)
};

template <>
inline constexpr auto kNames<Blocking> = name_list("areas", "one-sided");

/// Returns true if surfels are lobes in the light's basis.
bool blocks_by_lobes(Blocking blocking);

/// Returns the number of coefficients per sample of the geometry volume.
int blocking_size(Blocking blocking, const Basis& basis);

/// Returns the weights of these coefficients in the blocking potential B of light along the unit
/// vector `direction`. `one_sided`: b_i(-direction). `areas`: |direction_a|, exact for light along
/// an axis and for surfels across an axis.
std::vector<double> blocking_weights(Blocking blocking, const Basis& basis,
                                     const LobeOptions& lobes, const glm::dvec3& direction);

}  // namespace clpv
