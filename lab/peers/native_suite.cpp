// SPDX-License-Identifier: MIT
// Suite `native`: propagation of sh2 in OpenCL, compared with C++, OpenMP and AVX2 on the host.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "basis/basis.hpp"
#include "peers/peers.hpp"
#include "peers/propagate_avx2.hpp"
#include "reference/propagate.hpp"
#include "support/error.hpp"
#include "support/named_enum.hpp"
#include "verify/comparison.hpp"
#include "verify/tolerances.hpp"

namespace clpv::bench {
namespace {

constexpr const char* kBasis = "sh2";  // basis of the hand-written code
constexpr const char* kNative = "native";

struct NativePropagation {
  std::unique_ptr<Basis> basis;
  Transport transport;
  PropagateAvx2 propagation;
  explicit NativePropagation(const RenderOptions& o)
      : basis(make_basis(o)),
        transport(make_transport(o, *basis)),
        propagation(*basis, transport, o.grid) {}
};

Job native_job(Bench& bench, const Problem& problem) {
  if (!avx2_supported()) throw Error(ExitCode::device, "this processor has no AVX2");
  const RenderOptions& o = problem.options;
  const auto p = std::make_shared<NativePropagation>(o);
  const verify::SharedVolume light = bench.inputs().light(*p->basis, 0),
                             geometry =
                                 o.blocked() ? bench.inputs().geometry(*p->basis, 0) : nullptr;
  p->propagation.set(light->values, geometry ? &geometry->values : nullptr);
  Job job;
  job.own_stages = true;  // runs on the host: wall time
  job.run = [p, steps = o.iterations] { p->propagation.propagate(steps); };
  job.compare = [p, o, light, geometry] {
    return verify::compare_volumes(
        p->propagation.accumulated(),
        reference::propagate(p->transport, *light, geometry.get(), o.iterations).accumulated.values,
        o.grid, verify::tolerance("propagate", o.format().storage));
  };
  job.cost.flops = p->propagation.flops(o.iterations);
  job.cost.bytes = p->propagation.bytes(o.iterations);
  job.cost.working_set =
      sizeof(float) * std::pow(o.grid, 3) * (3 * 3.0 * p->basis->size() + (o.blocked() ? 30 : 0));
  return job;
}

std::vector<Case> cases(Bench& bench, const SuiteOptions& options) {
  std::vector<Case> cases;
  for (const bool occlusion : {false, true}) {
    Problem problem = basis_problem(options, kBasis);
    problem.options.blockers = blockers_if(occlusion);
    cases.push_back(stage_case(bench, "native", kPropagate, problem));
    cases.push_back({make_row("native", kNative, problem),
                     [&bench, problem] { return native_job(bench, problem); }});
  }
  return cases;
}

/// The row of the hand-written code with the same occlusion; null if there is none, or for such a
/// row itself.
const Row* native_row(const std::vector<Row>& rows, const Row& row) {
  const auto native = std::ranges::find_if(rows, [&](const Row& other) {
    return other.stage == kNative && other.status == Status::ok &&
           other.problem->options.blocked() == row.problem->options.blocked();
  });
  return native == rows.end() || row.stage == kNative ? nullptr : &*native;
}

std::string native_table(const std::vector<Row>& rows) {
  const std::size_t width = name_width(rows);
  const std::string head =
      fmt::format("{:<{}} {:>10} {:>9} {:>9} {:>9} {:>9} {:>8} {:>15} {:>9} {:>10} {:>9}\n", "row",
                  width, "median ms", "min ms", "mad", "wall ms", "GFLOP/s", "GB/s", "of ceiling",
                  "/ C++", "/ C++ wall", "error");
  const auto columns = [&](const Row& row) {
    const Row* native = native_row(rows, row);
    const auto ratio = [&](double opencl_ms, double native_ms) {
      return native != nullptr ? fmt::format("{:.2f}", opencl_ms / native_ms) : "-";
    };
    return fmt::format(
        "{:>10.3f} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.1f} {:>8.1f} {:>15} {:>9} {:>10} {:>9}",
        row.times.median, row.times.min, row.times.mad, row.wall_ms, row.gflops(), row.gbps(),
        fmt::format("{:.0f}% {}", 100 * row.ceiling_share, row.ceiling),
        ratio(row.times.median, native != nullptr ? native->times.median : 0),
        ratio(row.wall_ms, native != nullptr ? native->wall_ms : 0), error_text(row));
  };
  return head + row_lines(rows, width, columns) +
         "\n/ C++: median over that of the hand-written code (native), which the host's clock "
         "times. / C++ wall: the host's clock for both.\n";
}

}  // namespace

Suite native_suite() {
  return {"native", "propagation of sh2, compared with C++, OpenMP and AVX2",
          [](Session& session, const SuiteOptions& options) {
            const auto bench = make_bench(session, options, options.settings);
            return std::vector<Group>{{[bench, options] { return cases(*bench, options); }}};
          },
          native_table};
}

}  // namespace clpv::bench
