// SPDX-License-Identifier: MIT
// Job of stage `propagate`: injected light to accumulated light.
#include <fmt/format.h>

#include <cmath>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "bench/stage_jobs.hpp"
#include "pipeline/steps/propagate.hpp"
#include "reference/propagate.hpp"
#include "verify/comparison.hpp"
#include "verify/tolerances.hpp"

namespace clpv::bench {
namespace {

/// Volumes and kernels of one propagation.
struct Propagation {
  Variant variant;
  std::unique_ptr<Basis> basis;
  Transport transport;
  Volume injected, accumulated;
  std::unique_ptr<Volume> geometry;
  Propagator propagator;

  Propagation(Session& session, const Variant& v)
      : variant(v),
        basis(make_basis(v.options)),
        transport(make_transport(v.options, *basis)),
        injected(session, light_shape(), "bench: injected light", v.options.format()),
        accumulated(session, light_shape(), "bench: accumulated light", v.options.format()),
        propagator(session, *basis, transport, propagate_options(v.options)) {
    if (v.options.blocked())
      geometry = std::make_unique<Volume>(
          session, VolumeShape{v.options.grid + 1, blocking_size(v.options.blocking, *basis), 1},
          "bench: geometry volume", v.options.format());
  }
  VolumeShape light_shape() const { return {variant.options.grid, basis->size(), 3}; }
};

/// Bytes and memory accesses to read or write `coefficients` numbers of a cell in a format.
struct Access {
  VolumeFormat format;
  double bytes(int coefficients) const { return static_cast<double>(bytes_per_cell(format, coefficients)); }
  double count(int coefficients) const { return accesses_per_cell(format, coefficients); }
};

/// Adds the cost of one step. Bytes count each value once; reads count every access. `separate_sum`: the step reads the sum
/// so far besides its source.
void add_step(Cost& cost, Propagation& p, const TransportSource& source, bool separate_sum,
              double blocker_bytes, double blocker_reads) {
  const double cells = std::pow(p.variant.options.grid, 3);
  const Access access{p.variant.options.format()};
  const int carried = source.target_count;
  const double sum_in = separate_sum ? access.bytes(carried) : 0.0;
  cost.bytes +=
      cells *
      (kChannels * (access.bytes(source.source_count) + sum_in + 2 * access.bytes(carried)) + blocker_bytes);
  cost.flops += cells * kChannels * (source.arrive.flops() + carried);
  cost.reads_per_cell =
      kChannels * (source.neighbours * access.count(source.source_count) + access.count(carried)) +
      blocker_reads;
  cost.writes_per_cell = kChannels * 2 * access.count(carried);
}

/// Cost of the generated kernels, after a first run has built them. Reads and writes per cell are those of a later step.
Cost cost_of(Propagation& p) {
  const RenderOptions& o = p.variant.options;
  const int n = p.basis->size();
  const bool fluxes = o.state == State::fluxes;
  const int carried = fluxes ? 6 : n;
  const double cells = std::pow(o.grid, 3), corners = std::pow((o.grid + 1.0) / o.grid, 3);
  const Access access{o.format()};
  // Transmittance is computed once for all steps, a number per link, or in each step from the eight corners.
  const LinkTransmittance* transmitter = p.propagator.transmitter();
  const int links = transmitter != nullptr ? transmitter->transmittance().shape().coefficients : 0;
  const double blocker_bytes = transmitter != nullptr ? access.bytes(links) : corners * access.bytes(n);
  const double blocker_reads = transmitter != nullptr ? access.count(links) : 8 * access.count(n);
  const OperationCount evaluation =
      p.geometry ? transmittance_source(*p.basis, p.transport).operations : OperationCount{};
  Cost cost;
  for (int step = 1; step <= o.iterations; ++step) {
    const bool blocked = p.geometry && p.propagator.reads_transmittance(step);
    if (step == 1 && fluxes) {
      add_step(cost, p, transport_source(*p.basis, p.transport, {State::coefficients, State::fluxes, false}),
               true, 0, 0);
      continue;
    }
    add_step(cost, p, p.propagator.step_source(blocked), step > 1, blocked ? blocker_bytes : 0,
             blocked ? blocker_reads : 0);
    if (blocked && transmitter == nullptr) cost.flops += cells * evaluation.flops();
  }
  if (transmitter != nullptr) {
    cost.bytes += cells * (corners * access.bytes(n) + access.bytes(links));
    cost.flops += cells * evaluation.flops();
  }
  if (fluxes) {  // conversion of six fluxes to coefficients: a product with the lobes, and a sum
    cost.bytes += cells * kChannels * (2 * access.bytes(n) + access.bytes(carried));
    cost.flops += cells * kChannels * (2.0 * carried * n + n);
  }
  if (o.lobe_time == LobeTime::kernel) cost.flops = 0;  // lobes rotated at run time are not counted
  cost.working_set = cells * (3 * kChannels * access.bytes(carried) + (p.geometry ? blocker_bytes : 0));
  return cost;
}

std::string reference_key(const Variant& v) {
  const RenderOptions& o = v.options;
  return fmt::format("propagate {} {} {} {} {} {} {} {}", o.basis, o.lambda, name_of(o.transport),
                     lobes_of(o), o.blocked(), o.grid, o.iterations, v.cascade.value_or(0));
}

}  // namespace

Deviation compare_volumes(const std::vector<float>& device, const std::vector<double>& expected, int n,
                          double tolerance) {
  const reference::Comparison comparison = reference::compare_volumes(device, expected, n);
  return {comparison.worst, tolerance, comparison.place};
}

Job propagate_job(Bench& bench, const Variant& variant) {
  Session& session = bench.session;
  const auto p = std::make_shared<Propagation>(session, variant);
  const int cascade = variant.cascade.value_or(0);
  p->injected.write(session, bench.inputs().light(*p->basis, cascade));
  if (p->geometry) p->geometry->write(session, bench.inputs().geometry(*p->basis, cascade));
  const PropagateVolumes volumes{p->injected, p->geometry.get(), p->accumulated};
  p->propagator.propagate(volumes,
                          std::min(2, variant.options.iterations));  // builds the kernels for cost_of()
  Job job;
  job.cost = cost_of(*p);
  job.reset = [p, &session] { p->accumulated.clear(session); };
  job.run = [p] {
    p->propagator.propagate({p->injected, p->geometry.get(), p->accumulated}, p->variant.options.iterations);
  };
  job.verify = [p, &bench, cascade] {
    const int grid = p->variant.options.grid, n = p->basis->size();
    const auto expected = bench.expected(reference_key(p->variant), [&] {
      const auto light = to_reference(bench.inputs().light(*p->basis, cascade), grid, n, 3);
      const auto after_steps = [&](const reference::Volume* geometry) {
        return reference::propagate(p->transport, light, geometry, p->variant.options.iterations)
            .accumulated.values;
      };
      if (!p->geometry) return after_steps(nullptr);
      const auto geometry = to_reference(bench.inputs().geometry(*p->basis, cascade), grid + 1, n, 1);
      return after_steps(&geometry);
    });
    const RenderOptions& o = p->variant.options;
    // In half-floats, the rounding of storage is larger than that of lobes rotated at run time.
    const bool at_run_time = o.lobe_time == LobeTime::kernel && o.storage == Storage::float32;
    return compare_volumes(
        p->accumulated.read(bench.session), *expected, grid,
        reference::tolerance(at_run_time ? "propagate-run-time-lobes" : "propagate", o.format().storage));
  };
  return job;
}

}  // namespace clpv::bench
