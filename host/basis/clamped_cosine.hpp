// SPDX-License-Identifier: MIT
// The clamped cosine max(0, w . d) as a zonal series, and its integral against an Abel-Poisson
// kernel. max(0, t) = sum_k a_k P_k(t): a_0 = 1/4, a_1 = 1/2, other odd a_k = 0, a_2k = (4k+1)/2
// b_k, b_1 = 1/8, b_{k+1} = -b_k (2k-1)/(2k+4) (docs/bases.md, 'The clamped cosine').
#pragma once

#include <vector>

namespace clpv {

/// Returns A_l of band l: Int Y_lm(w) max(0, w . d) dw = A_l Y_lm(d); pi, 2 pi/3, pi/4, 0, -pi/24,
/// ... (Ramamoorthi and Hanrahan 2001).
double cosine_band(int band);

/// g(t) = Int G(w . xi; lambda) max(0, w . d) dw with t = xi . d, = 4 pi sum_k a_k lambda^k P_k(t).
/// Odd part: 2 pi lambda t. Even part: a series in P_2k, truncated where the remainder is below
/// 1e-17 of the first term, or at degree 2^15. With lambda near 1 that leaves an error of up to
/// 1e-6.
class CosineOfPoisson {
 public:
  explicit CosineOfPoisson(double lambda);

  double operator()(double t) const { return even(t) + slope_ * t; }
  double even(double t) const;             ///< (g(t) + g(-t)) / 2
  double slope() const { return slope_; }  ///< (g(t) - g(-t)) / 2 = slope t

  /// Returns c_k of the even part as a Chebyshev series in x = 2 t^2 - 1: sum_k c_k T_k(x).
  /// Truncated where coefficients fall below 1e-9 of c_0, at most 256 terms; for lambda > 0.97 the
  /// error at t = 0 is 1e-3.
  std::vector<double> chebyshev() const;

 private:
  double slope_;
  std::vector<double> terms_;  ///< 4 pi a_2k lambda^2k
};

}  // namespace clpv
