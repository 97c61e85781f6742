// SPDX-License-Identifier: MIT
// Suite `bases`: the cost of every basis, with either state and either lobe.
#include "basis/basis.hpp"
#include "bench/suites.hpp"
#include "support/named_enum.hpp"

namespace clpv::bench {
namespace {

std::vector<Case> cases_of(const std::shared_ptr<Bench>& bench, const SuiteOptions& options,
                           const std::string& basis) {
  std::vector<Case> cases;
  const Variant plain = plain_variant(options, basis);
  Variant variant = plain;
  cases.push_back(stage_case(*bench, "bases", kInject, variant));
  for (const LobeKind lobe : values_of<LobeKind>()) {
    for (const State state : values_of<State>()) {
      for (const bool occlusion : {false, true}) {
        variant.options.lobe = lobe, variant.options.state = state, variant.options.occlusion = occlusion;
        cases.push_back(stage_case(*bench, "bases", kPropagate, variant));
      }
    }
  }
  variant = plain;
  cases.push_back(stage_case(*bench, "bases", kGather, variant));
  return cases;
}

}  // namespace

Suite bases_suite() {
  return {"bases",
          "every basis, both states, both lobes: injection, propagation, gathering",
          [](Session& session, const SuiteOptions& options) {
            const auto bench = make_bench(session, options, options.settings);
            const auto names = options.bases.empty() ? basis_names() : options.bases;
            std::vector<Group> groups;  // one a basis: all of them at once would hold gigabytes
            for (const std::string& basis : names)
              groups.push_back({[bench, options, basis] { return cases_of(bench, options, basis); }});
            return groups;
          },
          {}};
}

}  // namespace clpv::bench
