// SPDX-License-Identifier: MIT
// Spherical radial basis functions: the Abel-Poisson kernel G at fixed centres, each with a bandwidth lambda_i.
// G(t; lambda) = (1 - lambda^2) / (1 - 2 lambda t + lambda^2)^(3/2), b_i(w) = G(w . xi_i; lambda_i), Int b_i dw
// = 4 pi, A_ij = Int b_i b_j dw = 4 pi G(xi_i . xi_j; lambda_i lambda_j): the 4 pi belongs there with the plain
// measure dw.
#pragma once

#include <map>

#include "basis/basis.hpp"
#include "basis/clamped_cosine.hpp"

namespace clpv {

/// G(t; lambda) for t in [-1, 1], lambda in (0, 1).
double abel_poisson(double t, double lambda);

class Srbf : public Basis {
 public:
  /// Unit centres and as many lambdas. Throws as make_basis_from_centres does.
  Srbf(const std::string& name, const std::vector<glm::dvec3>& centres, const std::vector<double>& lambdas);

  using Basis::evaluate;
  void evaluate(const glm::dvec3& w, std::span<double> b) const override;
  void cosine_integrals(const glm::dvec3& d, std::span<double> alpha) const override;
  std::string kernel_source() const override;

 private:
  std::map<double, CosineOfPoisson> cosines_;  ///< by lambda
};

struct SrbfSet {
  std::string name;
  std::vector<glm::dvec3> centres;
};

/// The named sets: srbf4, srbf6, srbf8v1, srbf8v2, srbf8v3, srbf14.
const std::vector<SrbfSet>& srbf_sets();

}  // namespace clpv
