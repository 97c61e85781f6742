// SPDX-License-Identifier: MIT
// Zonal functions as series, sum_k c_k mu^k P_k(t), with their slopes: what a search for centres climbs by.
#pragma once

#include <vector>

namespace clpv {

struct ZonalValue {
  double value, by_t, by_mu;
};

class ZonalSeries {
 public:
  /// c_k, k = 0, 1, ...
  explicit ZonalSeries(std::vector<double> coefficients) : coefficients_(std::move(coefficients)) {}

  /// For t in [-1, 1] and mu in (0, 1); terms are summed until mu^k is below double's resolution.
  ZonalValue operator()(double t, double mu) const;

 private:
  std::vector<double> coefficients_;
};

}  // namespace clpv
