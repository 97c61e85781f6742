// SPDX-License-Identifier: MIT
#include "basis/clamped_cosine.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clpv {
namespace {

using std::numbers::pi;
constexpr double kSeriesTail = 1e-17;  // below double's resolution of the sum
constexpr int kSeriesTerms = 1 << 14;  // 2^15 degrees
constexpr double kKernelTail = 1e-9;   // well below a float's resolution
constexpr int kKernelTerms = 256;  // straight-line code of this length compiles in reasonable time

// b_k = Int_0^1 t P_2k(t) dt, k >= 1.
double next_moment(double b, int k) {
  return -b * (2.0 * k - 1) / (2.0 * k + 4);
}

}  // namespace

double cosine_band(int band) {
  if (band == 0) return pi;
  if (band == 1) return 2 * pi / 3;
  if (band % 2 == 1) return 0;
  double b = 1.0 / 8;
  for (int k = 1; k < band / 2; ++k) b = next_moment(b, k);
  return 2 * pi * b;
}

CosineOfPoisson::CosineOfPoisson(double lambda) : slope_(2 * pi * lambda), terms_{pi} {
  double power = lambda * lambda, b = 1.0 / 8;
  for (int k = 1; k < kSeriesTerms; ++k) {
    const double term = 4 * pi * (4.0 * k + 1) / 2 * b * power;
    // The rest is at most a geometric series of ratio lambda^2.
    if (std::abs(term) < kSeriesTail * (1 - lambda * lambda)) break;
    terms_.push_back(term);
    power *= lambda * lambda;
    b = next_moment(b, k);
  }
}

double CosineOfPoisson::even(double t) const {
  double even = 1, odd = t, sum = terms_[0];  // P_0, P_1
  for (std::size_t i = 1; i < terms_.size(); ++i) {
    const double n = 2.0 * static_cast<double>(i);
    even = ((2 * n - 1) * t * odd - (n - 1) * even) / n;
    sum += terms_[i] * even;
    odd = ((2 * n + 1) * t * even - n * odd) / (n + 1);
  }
  return sum;
}

std::vector<double> CosineOfPoisson::chebyshev() const {
  constexpr int kNodes = 2 * kKernelTerms;
  const int nodes = std::clamp(4 * static_cast<int>(terms_.size()), 16, kNodes);
  std::vector<double> values;
  for (int j = 0; j < nodes; ++j) {
    // x = cos(theta) = 2 t^2 - 1, hence t = cos(theta / 2).
    values.push_back(even(std::cos(pi * (j + 0.5) / nodes / 2)));
  }
  std::vector<double> c;
  for (int k = 0; k < std::min(nodes, kKernelTerms); ++k) {
    double sum = 0;
    for (int j = 0; j < nodes; ++j) sum += values[j] * std::cos(pi * k * (j + 0.5) / nodes);
    c.push_back(sum * (k == 0 ? 1.0 : 2.0) / nodes);
  }
  while (c.size() > 1 && std::abs(c.back()) < kKernelTail * std::abs(c[0])) c.pop_back();
  return c;
}

}  // namespace clpv
