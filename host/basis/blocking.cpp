#include "basis/blocking.hpp"

#include <fmt/ranges.h>

#include <cmath>

#include "support/error.hpp"

namespace clpv {

std::vector<std::string> blocking_names() {
  return {"areas", "two-sided", "one-sided"};
}

Blocking blocking_named(const std::string& name) {
  if (name == "areas") return Blocking::areas;
  if (name == "two-sided") return Blocking::two_sided;
  if (name == "one-sided") return Blocking::one_sided;
  throw Error(ExitCode::usage, "there is no blocking '{}'; there are {}", name,
              fmt::join(blocking_names(), ", "));
}

int blocking_size(Blocking blocking, const Basis& basis) {
  return blocking == Blocking::areas ? 3 : basis.size();
}

std::vector<double> blocking_weights(Blocking blocking, const Basis& basis, const LobeOptions& lobes,
                                     const glm::dvec3& direction) {
  if (blocking != Blocking::areas) return evaluate(basis, lobes, -direction);
  return {std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)};
}

}  // namespace clpv
