// SPDX-License-Identifier: MIT
// What a search for centres makes small, and how well-conditioned a set is: both with their slopes by centres and lambdas.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "basis/clamped_cosine.hpp"
#include "basis/lobe_aims.hpp"
#include "basis/matrix.hpp"

namespace clpv {

/// A set of centres on its way; numbers as in make_basis_from_centres.
struct CentreSet {
  std::vector<glm::dvec3> centres;  ///< unit
  std::vector<double> lambdas;      ///< one a centre
};

/// A number that depends on a set, and its slopes. Those by centres are in space, not on the sphere.
struct SetValue {
  double value = 0;
  std::vector<glm::dvec3> by_centre;
  std::vector<double> by_lambda;
};

/// With alpha_i(d) = Int b_i(w) max(0, w . d) dw, M = <alpha alpha^T> over the aims, and A the Gram matrix:
class CentreObjective {
 public:
  explicit CentreObjective(LobeAims aims);

  /// error_over() squared: 1 - tr(A^-1 M) / (2 pi/3). Throws Error(run_time) where A is singular.
  SetValue square_error(const CentreSet& set) const;
  /// ln(tr A tr A^-1): a bound of the logarithm of A's condition number, from above. Throws the same.
  SetValue log_condition(const CentreSet& set) const;

 private:
  LobeAims aims_;
  ZonalSeries cosine_;         ///< alpha_i(d) of t = xi_i . d and lambda_i
  ZonalSeries second_moment_;  ///< M_ij over all directions, of t = xi_i . xi_j and lambda_i lambda_j
};

}  // namespace clpv
