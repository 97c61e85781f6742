// SPDX-License-Identifier: MIT
// Suite `ceilings`: what the device can do at most.
#include "bench/suites.hpp"

namespace clpv::bench {

Suite ceilings_suite() {
  return {"ceilings",
          "multiply-adds, bandwidth and launches of this device at most",
          [](Session& session, const SuiteOptions&) {
            return std::vector<Group>{{[&session] { return ceiling_cases(session); }}};
          },
          {}};
}

}  // namespace clpv::bench
