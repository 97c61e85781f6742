// SPDX-License-Identifier: MIT
#include "basis/zonal_series.hpp"

namespace clpv {
namespace {

constexpr double kNegligible = 1e-17;

}  // namespace

ZonalValue ZonalSeries::operator()(double t, double mu) const {
  ZonalValue sum{0, 0, 0};
  double p = 1, p_before = 0;          // P_k, P_{k-1}
  double slope = 0, slope_before = 0;  // their derivatives
  double power = 1, power_before = 0;  // mu^k, mu^(k-1)
  for (std::size_t i = 0; i < coefficients_.size() && power > kNegligible; ++i) {
    const auto k = static_cast<double>(i);
    const double c = coefficients_[i];
    sum.value += c * power * p;
    sum.by_t += c * power * slope;
    sum.by_mu += c * k * power_before * p;
    const double next = ((2 * k + 1) * t * p - k * p_before) / (k + 1);
    const double next_slope = slope_before + (2 * k + 1) * p;  // P'_{k+1} = P'_{k-1} + (2k+1) P_k
    p_before = p, p = next;
    slope_before = slope, slope = next_slope;
    power_before = power, power *= mu;
  }
  return sum;
}

}  // namespace clpv
