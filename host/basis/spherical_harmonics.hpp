// SPDX-License-Identifier: MIT
// Real spherical harmonics of bands 0 .. L-1, N = L^2, in the order l^2 + l + m; orthonormal, A =
// 1. Y_lm = K_lm (m < 0: Im, else Re) (x + iy)^|m| Q_lm(z), Q_lm = d^|m| P_l / dz^|m|; signs as in
// Y_1m = 0.4886 (y, z, x).
#pragma once

#include "basis/basis.hpp"

namespace clpv {

/// Basis of `bands`^2 real spherical harmonics.
class SphericalHarmonics : public Basis {
 public:
  explicit SphericalHarmonics(int bands);

  using Basis::evaluate;
  void evaluate(const glm::dvec3& w, std::span<double> b) const override;
  void cosine_integrals(const glm::dvec3& d, std::span<double> alpha) const override;
  void add_literals(Literals& literals) const override;
  int bands() const override { return bands_; }

 private:
  struct Function {
    int band, order;
    std::vector<double> polynomial;  ///< K_lm Q_lm: [i] is the coefficient of z^i
  };

  int bands_;
  std::vector<Function> functions_;
};

}  // namespace clpv
