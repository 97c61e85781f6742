// SPDX-License-Identifier: MIT
// Suite `bases`: the cost of every basis, with both lobes.
#include "basis/basis.hpp"
#include "bench/suites.hpp"
#include "support/named_enum.hpp"

namespace clpv::bench {
namespace {

std::vector<Case> cases_of(const std::shared_ptr<Bench>& bench, const SuiteOptions& options,
                           const std::string& basis) {
  std::vector<Case> cases;
  const Problem usual = basis_problem(options, basis);
  cases.push_back(stage_case(*bench, "bases", kInject, usual));
  Problem problem = usual;
  for (const LobeKind lobe : values_of<LobeKind>()) {
    for (const bool occlusion : {false, true}) {
      problem.options.lobe = lobe, problem.options.blockers = blockers_if(occlusion);
      cases.push_back(stage_case(*bench, "bases", kPropagate, problem));
    }
  }
  // The sweep's blockers are areas and do not depend on the basis: no case with occlusion.
  cases.push_back(stage_case(*bench, "bases", kSweep, usual));
  cases.push_back(stage_case(*bench, "bases", kGather, usual));
  return cases;
}

}  // namespace

Suite bases_suite() {
  return {"bases",
          "every basis with both lobes: injection, propagation, sweep, gathering",
          [](Session& session, const SuiteOptions& options) {
            const auto bench = make_bench(session, options, options.settings);
            return groups_by_basis(options.bases.empty() ? basis_names() : options.bases,
                                   [bench, options](const std::string& basis) {
                                     return cases_of(bench, options, basis);
                                   });
          },
          {}};
}

}  // namespace clpv::bench
