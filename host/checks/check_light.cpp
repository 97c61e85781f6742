// SPDX-License-Identifier: MIT
#include "checks/check_light.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace clpv::reference {

Volume random_light(const Basis& basis, int n, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(-0.3f, 1);
  Volume volume(n, basis.size());
  for (double& value : volume.values) value = uniform(random) > 0.5f ? uniform(random) : 0;
  return volume;
}

Volume random_blockers(int numbers, int n, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(-0.5f, 1);
  Volume volume(n + 1, numbers, 1);
  for (double& value : volume.values) value = std::max(0.0f, uniform(random));
  return volume;
}

void compare_cascade(const std::vector<float>& found, const Volume& twin, std::size_t cascade,
                     CheckResult& result) {
  double largest = 0;
  for (const double value : twin.values) largest = std::max(largest, std::abs(value));
  const std::size_t n = twin.n;
  for (std::size_t at = 0; at < found.size(); ++at) {
    const double error = std::abs(found[at] - twin.values[at]) / largest;
    if (error <= result.worst || std::isnan(result.worst)) continue;  // a NaN is not, and stays the worst
    result.worst = error;
    result.place = fmt::format("cascade {} cell {},{},{} plane {}: {:.7g}, twin {:.7g}", cascade, at % n,
                               at / n % n, at / n / n % n, at / n / n / n, found[at], twin.values[at]);
  }
}

}  // namespace clpv::reference
