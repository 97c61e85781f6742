// SPDX-License-Identifier: MIT
#include "support/statistics.hpp"

#include <algorithm>
#include <cmath>

namespace clpv {
namespace {

double quantile(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  const std::size_t high = std::min(low + 1, sorted.size() - 1);
  return std::lerp(sorted[low], sorted[high], at - static_cast<double>(low));
}

}  // namespace

Statistics statistics_of(std::vector<double> samples) {
  if (samples.empty()) return {};
  std::ranges::sort(samples);
  Statistics result{samples.front(), quantile(samples, 0.5), quantile(samples, 0.95),
                    samples.back()};
  for (double& sample : samples) sample = std::abs(sample - result.median);
  std::ranges::sort(samples);
  result.mad = quantile(samples, 0.5);
  return result;
}

}  // namespace clpv
