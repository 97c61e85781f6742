// SPDX-License-Identifier: MIT
// Suite `baseline`: propagation of sh2 in OpenCL against the same step in C++, OpenMP and AVX2 on the host.

#include <cmath>

#include "basis/basis.hpp"
#include "bench/baseline/propagate_avx2.hpp"
#include "bench/suites.hpp"
#include "checks/check.hpp"
#include "reference/propagate.hpp"
#include "support/error.hpp"
#include "support/named_enum.hpp"

namespace clpv::bench {
namespace {

constexpr const char* kBasis = "sh2";  // that the baseline is written for

struct Native {
  std::unique_ptr<Basis> basis;
  Transport transport;
  Baseline baseline;
  explicit Native(const Variant& v)
      : basis(make_basis(v.options)),
        transport(make_transport(v.options, *basis)),
        baseline(*basis, transport, v.options.grid) {}
};

Job native_job(Bench& bench, const Variant& variant) {
  if (!baseline_supported()) throw Error(ExitCode::device, "this processor has no AVX2");
  const auto p = std::make_shared<Native>(variant);
  const RenderOptions& o = variant.options;
  const std::vector<float>& light = bench.inputs().light(*p->basis, 0);
  const std::vector<float>& geometry = bench.inputs().geometry(*p->basis, 0);
  p->baseline.set(light, o.occlusion ? &geometry : nullptr);
  Job job;
  job.own_stages = true;  // nothing runs on the device: wall time
  job.run = [p, steps = o.iterations] { p->baseline.propagate(steps); };
  job.verify = [p, o, &light, &geometry] {
    const int n = p->basis->size();
    const reference::Volume injected = to_reference(light, o.grid, n, 3),
                            corners = to_reference(geometry, o.grid + 1, n, 1);
    return compare_volumes(
        p->baseline.accumulated(),
        reference::propagate(p->transport, injected, o.occlusion ? &corners : nullptr, o.iterations)
            .accumulated.values,
        o.grid, reference::tolerance_in("propagate", o.format()));
  };
  job.cost.flops = p->baseline.flops(o.iterations);
  job.cost.bytes = p->baseline.bytes(o.iterations);
  job.cost.working_set =
      sizeof(float) * std::pow(o.grid, 3) * (3 * 3.0 * p->basis->size() + (o.occlusion ? 30 : 0));
  return job;
}

std::vector<Case> cases(Bench& bench, const SuiteOptions& options) {
  std::vector<Case> cases;
  for (const bool occlusion : {false, true}) {
    Variant variant = plain_variant(options, kBasis);
    variant.options.occlusion = occlusion;
    for (const State state : values_of<State>()) {
      variant.options.state = state;
      cases.push_back(stage_case(bench, "baseline", kPropagate, variant));
    }
    variant.options.state = State::coefficients;
    Row row = make_row("baseline", "native", variant);
    cases.push_back({row, [&bench, variant] { return native_job(bench, variant); }});
  }
  return cases;
}

}  // namespace

Suite baseline_suite() {
  return {"baseline",
          "propagation of sh2 against C++ with OpenMP and AVX2",
          [](Session& session, const SuiteOptions& options) {
            const auto bench = make_bench(session, options, options.settings);
            return std::vector<Group>{{[bench, options] { return cases(*bench, options); }}};
          },
          {}};
}

}  // namespace clpv::bench
