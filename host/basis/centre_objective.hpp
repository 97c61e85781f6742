// SPDX-License-Identifier: MIT
// Objective and condition bound of the search for SRBF centres, with gradients by centres and lambdas (docs/bases.md,
// 'Searched centres').
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "basis/clamped_cosine.hpp"
#include "basis/lobe_aims.hpp"
#include "basis/matrix.hpp"

namespace clpv {

/// Candidate set of SRBF centres, as for make_basis_from_centres().
struct CentreSet {
  std::vector<glm::dvec3> centres;  ///< unit
  std::vector<double> lambdas;      ///< one per centre
};

/// Value of a function of a set, and its gradient. Gradients by centres are in R^3, not projected on the sphere.
struct SetValue {
  double value = 0;
  std::vector<glm::dvec3> by_centre;
  std::vector<double> by_lambda;
};

/// Functions of a set, with alpha_i(d) = Int b_i(w) max(0, w . d) dw, M = <alpha alpha^T> over the aims, Gram matrix A.
class CentreObjective {
 public:
  explicit CentreObjective(LobeAims aims);

  /// Square of error_over(): 1 - tr(A^-1 M) / (2 pi/3). Throws Error(run_time) if A is singular.
  SetValue square_error(const CentreSet& set) const;
  /// ln(tr A tr A^-1), an upper bound on the logarithm of A's condition number. Throws Error(run_time) if A is singular.
  SetValue log_condition(const CentreSet& set) const;

 private:
  LobeAims aims_;
  ZonalSeries cosine_;         ///< alpha_i(d) by t = xi_i . d and lambda_i
  ZonalSeries second_moment_;  ///< M_ij over all directions, by t = xi_i . xi_j and lambda_i lambda_j
};

}  // namespace clpv
