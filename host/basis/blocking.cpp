// SPDX-License-Identifier: MIT
#include "basis/blocking.hpp"

#include <cmath>

namespace clpv {

bool blocks_by_lobes(Blocking blocking) {
  switch (blocking) {
    case Blocking::areas:
      return false;
    case Blocking::one_sided:
      return true;
  }
  return true;
}

int blocking_size(Blocking blocking, const Basis& basis) {
  switch (blocking) {
    case Blocking::areas:
      return 3;
    case Blocking::one_sided:
      break;
  }
  return basis.size();
}

std::vector<double> blocking_weights(Blocking blocking, const Basis& basis,
                                     const LobeOptions& lobes, const glm::dvec3& direction) {
  switch (blocking) {
    case Blocking::areas:
      return {std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)};
    case Blocking::one_sided:
      break;
  }
  return evaluate(basis, lobes, -direction);
}

}  // namespace clpv
