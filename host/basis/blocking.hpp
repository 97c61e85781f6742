// What blocks light: what a surfel adds to a sample of the geometry volume, and how much of the light along a direction
// such a sample keeps back (MATH section 4). Knows no OpenCL.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "basis/basis.hpp"
#include "basis/rotated_lobe.hpp"

namespace clpv {

/// A surfel that covers the share A of a cell's cross-section, its normal n.
enum class Blocking {
  one_sided,  ///< N coefficients: A times the clamped cosine round n; blocks what meets its front (the paper)
  two_sided,  ///< N coefficients: that round n and that round -n
  /// 3 numbers: A |n_x|, A |n_y|, A |n_z|, which is what it covers of a face across each axis. Two-sided lobes of few
  /// coefficients hardly know which way their surfel lies: |w . n| is even, and of sh2's functions the constant alone is.
  areas,
};

/// "one-sided", "two-sided", "areas". Throws Error(usage) for another name.
Blocking blocking_named(const std::string& name);
std::vector<std::string> blocking_names();

/// Numbers a sample of the geometry volume has.
int blocking_size(Blocking blocking, const Basis& basis);

/// Weights of those numbers whose sum is the share B of light travelling along `direction` (unit) that is blocked: a
/// basis looked up against it, b(-direction); areas by |direction_a|, exact for light along an axis, and for surfels
/// across one whatever the light.
std::vector<double> blocking_weights(Blocking blocking, const Basis& basis, const LobeOptions& lobes,
                                     const glm::dvec3& direction);

}  // namespace clpv
