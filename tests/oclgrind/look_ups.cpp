// SPDX-License-Identifier: MIT
// Runs probes.cl for each of its ways, at points that fill no work-group.
#include <fmt/format.h>

#include "bench/runner.hpp"
#include "bench/suites.hpp"
#include "device/session.hpp"

int main() {
  using namespace clpv;
  bench::SuiteOptions options;
  options.settings.width = 5, options.settings.height = 3;
  Session session(choose_device());
  for (const bench::Group& group : bench::probes_suite().groups(session, options)) {
    for (const bench::Row& row : bench::run_cases(session, group(), {.repetitions = 1})) {
      if (row.status == bench::Status::ok) continue;
      fmt::print(stderr, "{}: {}\n", row.name, row.reason);
      return 1;
    }
  }
}
