// SPDX-License-Identifier: MIT
// Suite `baseline`: propagation of sh2 in OpenCL against the same in C++, OpenMP and AVX2 on the host.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "basis/basis.hpp"
#include "bench/baseline/propagate_avx2.hpp"
#include "bench/suites.hpp"
#include "reference/propagate.hpp"
#include "support/error.hpp"
#include "support/named_enum.hpp"
#include "verify/tolerances.hpp"

namespace clpv::bench {
namespace {

constexpr const char* kBasis = "sh2";  // that the baseline is written for
constexpr const char* kNative = "native";

struct Native {
  std::unique_ptr<Basis> basis;
  Transport transport;
  PropagateBaseline baseline;
  explicit Native(const RenderOptions& o)
      : basis(make_basis(o)), transport(make_transport(o, *basis)), baseline(*basis, transport, o.grid) {}
};

Job native_job(Bench& bench, const Variant& variant) {
  if (!baseline_supported()) throw Error(ExitCode::device, "this processor has no AVX2");
  const RenderOptions& o = variant.options;
  const auto p = std::make_shared<Native>(o);
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
        o.grid, reference::tolerance("propagate", o.format().storage));
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
    cases.push_back(
        {make_row("baseline", kNative, variant), [&bench, variant] { return native_job(bench, variant); }});
  }
  return cases;
}

/// The row by hand that does the same work.
const Row* native_row(const std::vector<Row>& rows, const Row& row) {
  const auto found = std::ranges::find_if(rows, [&](const Row& other) {
    return other.stage == kNative && other.status == Status::ok &&
           other.variant->options.occlusion == row.variant->options.occlusion;
  });
  return found == rows.end() || row.stage == kNative ? nullptr : &*found;
}

std::string baseline_table(const std::vector<Row>& rows) {
  const std::size_t width = name_width(rows);
  const std::string head = fmt::format(
      "{:<{}} {:>10} {:>9} {:>9} {:>9} {:>9} {:>8} {:>15} {:>10} {:>9} {:>9}\n", "row", width, "median ms",
      "least", "mad", "wall ms", "GFLOP/s", "GB/s", "of ceiling", "over C++", "by wall", "error");
  const auto columns = [&](const Row& row) {
    const Row* native = native_row(rows, row);
    const auto over = [&](double here, double there) {
      return native != nullptr ? fmt::format("{:.2f}", here / there) : "-";
    };
    return fmt::format("{:>10.3f} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.1f} {:>8.1f} {:>15} {:>10} {:>9} {:>9.1e}",
                       row.times.median, row.times.min, row.times.mad, row.wall_ms, row.gflops(), row.gbps(),
                       fmt::format("{:.0f}% {}", 100 * row.ceiling_share, row.ceiling),
                       over(row.times.median, native != nullptr ? native->times.median : 0),
                       over(row.wall_ms, native != nullptr ? native->wall_ms : 0),
                       row.max_rel_error.value_or(0));
  };
  return head + row_lines(rows, width, columns) +
         "\nover C++: of the same work by hand (native), which is timed by the host's clock: medians; by "
         "wall: the host's clock for "
         "both.\n";
}

}  // namespace

Suite baseline_suite() {
  return {"baseline", "propagation of sh2 against C++ with OpenMP and AVX2",
          [](Session& session, const SuiteOptions& options) {
            const auto bench = make_bench(session, options, options.settings);
            return std::vector<Group>{{[bench, options] { return cases(*bench, options); }}};
          },
          baseline_table};
}

}  // namespace clpv::bench
