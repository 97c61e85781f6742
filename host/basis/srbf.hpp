// SPDX-License-Identifier: MIT
// Spherical radial basis functions (SRBF): Abel-Poisson kernels G at fixed centres xi_i with
// bandwidths lambda_i.
//   G(t; lambda) = (1 - lambda^2) / (1 - 2 lambda t + lambda^2)^(3/2)
//   b_i(w) = G(w . xi_i; lambda_i),  Int b_i dw = 4 pi
//   A_ij = Int b_i b_j dw = 4 pi G(xi_i . xi_j; lambda_i lambda_j)
#pragma once

#include <map>

#include "basis/basis.hpp"
#include "basis/clamped_cosine.hpp"

namespace clpv {

/// Returns G(t; lambda) for t in [-1, 1], lambda in (0, 1).
double abel_poisson(double t, double lambda);

/// Basis of SRBFs.
class Srbf : public Basis {
 public:
  /// Unit centres and one lambda per centre. Throws like make_basis_from_centres().
  Srbf(const std::string& name, const std::vector<glm::dvec3>& centres,
       const std::vector<double>& lambdas);

  using Basis::evaluate;
  void evaluate(const glm::dvec3& w, std::span<double> b) const override;
  void cosine_integrals(const glm::dvec3& d, std::span<double> alpha) const override;
  void add_literals(Literals& literals) const override;

 private:
  std::map<double, CosineOfPoisson> cosines_;  ///< by lambda
};

/// A named set of unit centres.
struct SrbfSet {
  std::string name;
  std::vector<glm::dvec3> centres;
};

/// Returns the named sets: srbf4, srbf6, srbf8v1, srbf8v2, srbf8v3, srbf14.
const std::vector<SrbfSet>& srbf_sets();

}  // namespace clpv
